-- 1e6 turns of vector arithmetic: add, scale, norm, cross, assign.
local vector = require "vector"
local add, scale, cross, norm = vector.add, vector.scale, vector.cross, vector.norm

local place, course = {0.0, 0.0, 0.0}, {1.0, 2.0, 3.0}
local sum = 0.0

for _ = 1, 1000000 do
  place = add(scale(place, 0.5), course)
  local turn = cross(place, {0.25, 0.5, 1.0})
  local length = norm(turn)
  course = scale(turn, 1.0 / (1.0 + length))
  sum = sum + length
end

print(string.format("%s %.6f", vector.text(place), sum))
