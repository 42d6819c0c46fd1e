-- Agents hear what others announce.
local Herald = breve.class("Herald", "Mobile")
function Herald:init() self.turn = 0 end
function Herald:iterate()
  self.turn = self.turn + 1
  if self.turn % 3 == 0 then self:announce("bell") end
end
local Guard = breve.class("Guard", "Mobile")
function Guard:listen(herald)
  self:observe{instance = herald, for_notification = "bell", with_method = "wake"}
end
function Guard:wake()
  print("awake")
  self:offset(breve.vector(1, 0, 0))
end
local Main = breve.class("Main", "Control")
function Main:init()
  local herald, guard = Herald(), Guard()
  guard:listen(herald)
end
breve.main(Main)
