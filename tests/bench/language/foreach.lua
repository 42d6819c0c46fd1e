-- Walk a list of 1e6 numbers with ipairs. Twenty walks, so that building the list counts little.
local numbers = {}
local sum = 0.0

for i = 0, 999999 do numbers[#numbers + 1] = i * 0.5 end

for _ = 1, 20 do
  for _, number in ipairs(numbers) do sum = sum + number end
end

print(string.format("%.6f", sum))
