-- Insert and look up 1e6 string keys and 1e6 integer keys.
local names, ages, places = {}, {}, {}
local sum = 0.0

for i = 0, 999999 do names[#names + 1] = "agent-" .. i end

for i = 0, 999999 do ages[names[i + 1]] = i % 100 end
for _, name in ipairs(names) do sum = sum + ages[name] end

for i = 0, 999999 do places[i * 2003] = i end
for i = 0, 999999 do sum = sum + places[i * 2003] end

print(string.format("%.6f", sum))
