-- A handler runs at the moment of touch, and what it sets holds from there on.
local Ball = breve.class("Ball", "Mobile")
function Ball:init() self:handle_collisions{with_type = "Ball", with_method = "bounce"} end
function Ball:bounce(with_object)
  print("touch")
  self:set_velocity(self:get_velocity() * -1)
end
local Main = breve.class("Main", "Control")
function Main:init()
  local a, b = Ball(), Ball()
  a:move(breve.vector(-3, 0, 0))
  b:move(breve.vector(3, 0.5, 0))
  a:set_velocity(breve.vector(8, 0, 0))
  b:set_velocity(breve.vector(-7, 0, 0))
end
breve.main(Main)
