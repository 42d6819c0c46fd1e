-- Agents that follow those within their neighbourhood.
local Bug = breve.class("Bug", "Mobile")
function Bug:init()
  self:move(breve.random(breve.vector(10, 10, 10)))
  self:set_neighborhood_size(4)
end
function Bug:iterate()
  local sum = breve.vector(0, 0, 0)
  for other in self:neighbors() do sum = sum + (other:get_location() - self:get_location()) end
  self:set_velocity(sum / 4)
end
local Main = breve.class("Main", "Control")
function Main:init() breve.new("Bug", 30) end
function Main:iterate()
  self:update_neighbors()
  Main.super.iterate(self)
end
breve.main(Main)
