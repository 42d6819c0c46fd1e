-- A loop of 1e7 turns of arithmetic on local variables.
local x, y = 0.0, 0.0

for i = 0, 9999999 do
  x = x * 0.5 + i * 0.25
  y = y * 0.875 + x / 3.0 - 1.0
end

print(string.format("%.6f %.6f", x, y))
