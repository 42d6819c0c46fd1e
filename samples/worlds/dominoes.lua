-- A spiral of dominoes, in Lua: bodies with physics, one impulse, and a controller that watches them fall.
-- What it teaches: shapes, physics and gravity from Lua; the accuracy of stacks; reading where bodies are.

breve.use("Floor", "Shape", "Mobile")

local STONES = 40
local SIZE = breve.vector(0.18, 1.2, 0.5)  -- thick, high, wide
local GAP = 0.55                           -- from one stone to the next along the spiral

local Domino = breve.class("Domino", "Mobile")

-- Standing means that the long side still points up.
function Domino:standing()
  local up = self:get_rotation()
  return up[5] > 0.9
end

local Table = breve.class("Table", "PhysicalControl")

function Table:init()
  breve.new("Floor")
  local shape = breve.new("Shape"):init_with_cube(SIZE)
  self.stones, self.fallen = {}, 0
  local angle, radius = 0.0, 3.0
  for i = 1, STONES do
    local stone = Domino()
    stone:set_shape(shape)
    stone:move(breve.vector(radius * math.cos(angle), SIZE.y / 2, radius * math.sin(angle)))
    -- The thin side faces along the spiral.
    stone:rotate{around_axis = breve.vector(0, 1, 0), by = math.pi / 2 - angle}
    stone:set_color(breve.vector(0.9, 0.25 + 0.6 * i / STONES, 0.2))
    stone:enable_physics()
    self.stones[i] = stone
    angle = angle + GAP / radius
    radius = radius + 0.25 * GAP / radius
  end
  self:point_camera{at = breve.vector(0, 0, 0), from = breve.vector(6, 9, 9)}
  self:schedule{method_call = "give_push", at_time = 0.5}
end

-- The first stone topples along the spiral: its upper edge moves, its lower edge stays.
function Table:give_push()
  self.stones[1]:set_velocity(breve.vector(0, 0, 1.5))
  self.stones[1]:set_rotational_velocity(breve.vector(1.5 / (SIZE.y / 2), 0, 0))
end

function Table:iterate()
  Table.super.iterate(self)
  local fallen = 0
  for _, stone in ipairs(self.stones) do
    if not stone:standing() then fallen = fallen + 1 end
  end
  if fallen > self.fallen and fallen % 8 == 0 then
    print(string.format("%.1f s: %d of %d have fallen", breve.time(), fallen, STONES))
  end
  self.fallen = fallen
end

breve.main(Table)
