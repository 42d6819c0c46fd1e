-- 1e7 calls of another object's method with two arguments.
local Mixer = {}
Mixer.__index = Mixer

function Mixer:blend(a, b)
  return a * 0.5 + b
end

local mixer = setmetatable({}, Mixer)
local total = 0.0
for i = 0, 9999999 do total = mixer:blend(total, i) end

print(string.format("%.6f", total))
