-- Both languages draw the same numbers from the world's generator.
local Bug = breve.class("Bug", "Mobile")
function Bug:init() self:move(breve.random(breve.vector(10, 10, 10))) end
function Bug:iterate()
  if breve.random(3) == 0 then
    self:set_velocity(breve.random(breve.vector(2, 2, 2)) - breve.vector(1, 1, 1))
  end
end
local Main = breve.class("Main", "Control")
function Main:init() breve.new("Bug", 20) end
function Main:iterate()
  print(breve.random(1000))
  Main.super.iterate(self)
end
breve.main(Main)
