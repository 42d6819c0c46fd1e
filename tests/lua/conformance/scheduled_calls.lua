-- Calls that come due, once and again and again.
local Bug = breve.class("Bug", "Mobile")
function Bug:init()
  self:schedule{method_call = "hop", at_time = 0.2}
  self:schedule_repeating{method_call = "step_on", with_interval = 0.1}
end
function Bug:hop()
  print("hop")
  self:offset(breve.vector(0, 5, 0))
end
function Bug:step_on() self:offset(breve.vector(1, 0, 0)) end
local Main = breve.class("Main", "Control")
function Main:init() breve.new("Bug", 3) end
breve.main(Main)
