-- A flock of birds after Craig Reynolds, "Flocks, Herds, and Schools: A Distributed Behavioral Model" (1987), in Lua.
-- What it teaches: classes in Lua, agents that see only their neighbours, a collision handler, scheduled calls.
--
-- No bird knows the flock. Each one follows three urges, and the flock is what they amount to together:
--   keep clear of those too near, fly the way the others fly, stay with the others.

breve.use("Floor", "Shape")             -- what of the class library is made by name

local BIRDS = 200
local ROOST = breve.vector(0, 9, 0)     -- the place in the air that the birds like to be near
local CRUISE, TOP_SPEED = 7.0, 12.0     -- length units per second

local function shorten(arrow, limit)
  local length = arrow:length()
  return length > limit and arrow * (limit / length) or arrow
end

local Bird = breve.class("Bird", "Mobile")

function Bird:init()
  self.landed = false
  self:move(breve.vector(-10, 3, -10) + breve.random(breve.vector(20, 12, 20)))
  self:set_velocity(breve.random(breve.vector(10, 4, 10)) - breve.vector(5, 2, 5))
  self:set_color(breve.vector(0.3, 0.3, 0.5) + breve.random(breve.vector(0.4, 0.4, 0.4)))
  self:set_neighborhood_size(6.0)
  self:handle_collisions{with_type = "Floor", with_method = "touch_ground"}
end

function Bird:iterate()
  if self.landed then return end
  local mood = breve.controller()
  local here, velocity = self:get_location(), self:get_velocity()
  local x, y, z = here:unpack()
  local ax, ay, az = 0.0, 0.0, 0.0  -- away from the others
  local cx, cy, cz = 0.0, 0.0, 0.0  -- the course of the others
  local mx, my, mz = 0.0, 0.0, 0.0  -- the middle of the others, seen from here
  local mates = 0

  -- The loop gives each neighbour with its place and velocity, as numbers: they cost nothing to compute with.
  for mate, px, py, pz, vx, vy, vz in self:neighbors() do
    -- Everything with a position is a neighbour, even the floor; only birds make a flock.
    if mate.landed ~= nil then
      local dx, dy, dz = px - x, py - y, pz - z
      local distance = math.sqrt(dx * dx + dy * dy + dz * dz)
      if distance > 0.0 then
        -- The nearer, the stronger: a push that falls off with the square of the distance.
        local weight = distance * distance * distance + 0.01
        ax, ay, az = ax - dx / weight, ay - dy / weight, az - dz / weight
      end
      cx, cy, cz = cx + vx, cy + vy, cz + vz
      mx, my, mz = mx + dx, my + dy, mz + dz
      mates = mates + 1
    end
  end

  local urge = breve.vector(ax, ay, az) * mood.clearance
  if mates > 0 then
    urge = urge + (breve.vector(cx, cy, cz) / mates - velocity) * mood.matching
    urge = urge + breve.vector(mx, my, mz) / mates * mood.centering
  end
  urge = urge + (ROOST - here) * mood.homing
  urge = urge + (breve.random(breve.vector(2, 2, 2)) - breve.vector(1, 1, 1)) * mood.caprice

  self:set_acceleration(shorten(urge, 20.0))
  self:_keep_speed(velocity)
  self:point{vertex = breve.vector(0, 1, 0), at = self:get_velocity()}
end

-- A bird can neither stand in the air nor fly at any speed: drift toward the cruising speed, and stop at the top.
function Bird:_keep_speed(velocity)
  local speed = velocity:length()
  if speed == 0.0 then return end
  self:set_velocity(shorten(velocity * (1.0 + 0.05 * (CRUISE - speed) / speed), TOP_SPEED))
end

-- The floor was touched, and this is the moment: sit down just above it, and leave in a while.
function Bird:touch_ground(floor)
  if self.landed then return 0 end
  self.landed = true
  local place = self:get_location()
  self:set_velocity(breve.vector(0, 0, 0))
  self:set_acceleration(breve.vector(0, 0, 0))
  self:point{vertex = breve.vector(0, 1, 0), at = breve.vector(0, 1, 0)}
  self:move(breve.vector(place.x, 0.3, place.z))
  self:schedule{method_call = "take_off", at_time = breve.time() + 1.0 + breve.random(3.0)}
  return 0
end

function Bird:take_off()
  self.landed = false
  self:set_velocity(breve.vector(breve.random(4.0) - 2.0, 6.0, breve.random(4.0) - 2.0))
end

local Flock = breve.class("Flock", "Control")

function Flock:init()
  self:set_integration_step(0.04)
  self:set_iteration_step(0.04)
  breve.new("Floor")

  -- How much each urge counts. Every bird reads them.
  self.clearance, self.matching, self.centering, self.homing, self.caprice = 4.0, 3.0, 1.0, 0.1, 1.0

  -- One shape serves all birds: shapes are shared, bodies are not.
  local shape = breve.new("PolygonCone"):init_with{sides = 5, height = 0.5, radius = 0.15}
  self.birds = breve.new(Bird, BIRDS)
  for _, bird in ipairs(self.birds) do bird:set_shape(shape) end

  self:point_camera{at = ROOST, from = breve.vector(0, 4, 40)}
  self:report()
  self:schedule_repeating{method_call = "report", with_interval = 4.0}
end

function Flock:iterate()
  -- Who is whose neighbour is settled once, before anyone moves: all birds decide on the same picture.
  self:update_neighbors()
  Flock.super.iterate(self)
end

-- The mean distance of the birds from their common centre, in length units.
function Flock:get_spread()
  local center, sum = breve.vector(0, 0, 0), 0.0
  for _, bird in ipairs(self.birds) do center = center + bird:get_location() end
  center = center / #self.birds
  for _, bird in ipairs(self.birds) do sum = sum + (bird:get_location() - center):length() end
  return sum / #self.birds
end

function Flock:get_landed_count()
  local count = 0
  for _, bird in ipairs(self.birds) do if bird.landed then count = count + 1 end end
  return count
end

function Flock:report()
  print(string.format("time %.2f spread %.3f landed %d", breve.time(), self:get_spread(), self:get_landed_count()))
end

breve.main(Flock)
