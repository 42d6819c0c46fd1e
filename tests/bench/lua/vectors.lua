-- The turns of language/vectors.lua with breve's vectors: add, scale, norm, cross, assign.
local Main = breve.class("Main", "Control")

function Main:turn(count)
  local place, course = breve.vector(0, 0, 0), breve.vector(1, 2, 3)
  local axis = breve.vector(0.25, 0.5, 1)
  local sum = 0.0
  for _ = 1, count do
    place = place * 0.5 + course
    local turn = place:cross(axis)
    local length = turn:length()
    course = turn * (1.0 / (1.0 + length))
    sum = sum + length
  end
  return sum
end

function Main:empty(count)
  for _ = 1, count do end
  return 0.0
end

function Main:call_native(count)
  local time
  for _ = 1, count do time = self:get_time() end
  return time
end

breve.main(Main)
