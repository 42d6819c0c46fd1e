-- A list that grows, is walked through and passed to a method.
breve.use("Mobile")
local Main = breve.class("Main", "Control")
function Main:init()
  self.trail = {}
  self.bug = breve.new("Mobile")
end
function Main:total(numbers)
  local sum = 0
  for _, number in ipairs(numbers) do sum = sum + number end
  return sum
end
function Main:iterate()
  self.trail[#self.trail + 1] = #self.trail * #self.trail
  print(self:total(self.trail))
  self.bug:move(breve.vector(self.trail[#self.trail], #self.trail, 0))
  Main.super.iterate(self)
end
breve.main(Main)
