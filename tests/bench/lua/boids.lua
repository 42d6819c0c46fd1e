-- The boids of language/boids.lua, whose neighbours and motion are the world's.
local STEP = 0.05
local CENTER = breve.vector(10, 10, 10)

local Boid = breve.class("Boid", "Mobile")

function Boid:init()
  self:set_neighborhood_size(3.0)
end

function Boid:iterate()
  local here, velocity = self:get_location(), self:get_velocity()
  local x, y, z = here:unpack()
  local ax, ay, az, cx, cy, cz, mx, my, mz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
  local mates = 0

  for _, px, py, pz, vx, vy, vz in self:neighbors() do
    local dx, dy, dz = px - x, py - y, pz - z
    local weight = 1.0 / (dx * dx + dy * dy + dz * dz + 0.1)
    ax, ay, az = ax - dx * weight, ay - dy * weight, az - dz * weight
    cx, cy, cz = cx + vx, cy + vy, cz + vz
    mx, my, mz = mx + dx, my + dy, mz + dz
    mates = mates + 1
  end

  local urge = breve.vector(ax, ay, az) * 2.0 + (CENTER - here) * 0.1
  if mates > 0 then
    urge = urge + (breve.vector(cx, cy, cz) / mates - velocity) + breve.vector(mx, my, mz) / mates
  end
  velocity = velocity + urge * STEP
  local speed = velocity:length()
  if speed > 5.0 then velocity = velocity * (5.0 / speed) end
  self:set_velocity(velocity)
end

local Bench = breve.class("Bench", "Control")
local seed = 1.0

-- 0 to 1, by the generator of Park and Miller (1988).
local function draw_number()
  seed = seed * 16807.0 % 2147483647.0
  return seed / 2147483647.0
end

local function draw(limit)
  local x, y, z = draw_number(), draw_number(), draw_number()
  return breve.vector(x, y, z) * limit
end

function Bench:init()
  self:set_integration_step(STEP)
  self:set_iteration_step(STEP)
  self.boids = breve.new(Boid, 1000)
  for _, boid in ipairs(self.boids) do
    boid:move(draw(20.0))
    boid:set_velocity(draw(4.0) - breve.vector(2, 2, 2))
  end
  self.iterations = 0
end

function Bench:iterate()
  Bench.super.iterate(self)
  self:update_neighbors()
end

function Bench:post_iterate()
  self.iterations = self.iterations + 1
  if self.iterations ~= 50 then return end
  for _, boid in ipairs(self.boids) do
    print(string.format("%.6f %.6f %.6f", boid:get_location():unpack()))
  end
end

breve.main(Bench)
