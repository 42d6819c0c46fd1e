-- Values by name.
breve.use("Mobile")
local Main = breve.class("Main", "Control")
function Main:init()
  self.bug, self.turn = breve.new("Mobile"), 0
  self.places = {a = breve.vector(1, 0, 0), b = breve.vector(0, 2, 0)}
end
function Main:iterate()
  self.turn = self.turn + 1
  self.bug:move(self.turn % 2 == 1 and self.places.a or self.places.b)
  self.places.a = self.places.a * 2
  Main.super.iterate(self)
end
breve.main(Main)
