-- Sums, products and lengths of vectors decide where an agent goes.
local Bug = breve.class("Bug", "Mobile")
function Bug:iterate()
  local here = self:get_location() + breve.vector(0.1, 0.2, 0.3)
  if here:length() > 1 then here = here / here:length() end
  self:move(here * 0.9 - breve.vector(0, 0, 0.05))
end
local Main = breve.class("Main", "Control")
function Main:init() Bug() end
breve.main(Main)
