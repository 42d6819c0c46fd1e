-- Sort 1e5 numbers with a comparison function. The numbers come from the generator of Park and Miller (1988).
local numbers = {}
local seed = 1.0

for _ = 1, 100000 do
  seed = seed * 16807.0 % 2147483647.0
  numbers[#numbers + 1] = seed
end

table.sort(numbers, function(a, b) return a < b end)

local sum = 0.0
for i = 1, 100000 do sum = sum * 0.5 + numbers[i] end
print(string.format("%.6f %.6f %.6f %.6f", numbers[1], numbers[50001], numbers[100000], sum))
