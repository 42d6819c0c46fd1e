-- Push 1e6 numbers onto a list, then read each by its index.
local numbers = {}
local sum = 0.0

for i = 0, 999999 do numbers[#numbers + 1] = i * 3 end
for i = 1, 1000000 do sum = sum + numbers[i] end

print(string.format("%d %.6f", #numbers, sum))
