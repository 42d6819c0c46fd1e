-- Build 2e5 lines of text by concatenation, keep them, and look into them.
local lines, bytes = {}, 0

for i = 0, 199999 do
  local name = i % 2 == 1 and "hawk" or "dove"
  local points = i * 7 % 1000
  local line = name .. " number " .. i .. " has " .. points .. " points\n"
  lines[#lines + 1] = line
  bytes = bytes + #line
end

local line = lines[100001]
print(bytes, line:sub(6, 6))
