-- Bodies with physics fall and come to rest on each other; some are freed on the way.
breve.use("Floor")
local Stone = breve.class("Stone", "Mobile")
function Stone:init()
  self:move(breve.vector(breve.random(1.0), 4 + breve.random(3.0), breve.random(1.0)))
  self:enable_physics()
end
local Main = breve.class("Main", "PhysicalControl")
function Main:init()
  breve.new("Floor")
  self.stones, self.turn = breve.new("Stone", 4), 0
end
function Main:iterate()
  self.turn = self.turn + 1
  if self.turn == 6 then breve.free(self.stones[2]) end
  Main.super.iterate(self)
end
breve.main(Main)
