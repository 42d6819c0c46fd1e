-- Build a text out of 2e5 lines.
local lines = {}

for i = 0, 199999 do
  local name = i % 2 == 1 and "hawk" or "dove"
  local points = i * 7 % 1000
  lines[#lines + 1] = name .. " number " .. i .. " has " .. points .. " points\n"
end

local text = table.concat(lines)
print(#text, text:sub(1000001, 1000001), text:sub(5000001, 5000001))
