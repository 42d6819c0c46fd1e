-- 50 iterations of 1,000 boids that see what is nearer than 3 units. A grid with cells of that size finds the neighbours.
local vector = require "vector"
local add, sub, scale, norm = vector.add, vector.sub, vector.scale, vector.norm
local floor = math.floor

local STEP, RADIUS = 0.05, 3.0
local CENTER = {10.0, 10.0, 10.0}

-- The place of a cell in the grid's table: cell numbers from -500 to 499 on each axis.
local ROW, LAYER = 1000, 1000000

local seed = 1.0

-- 0 to 1, by the generator of Park and Miller (1988).
local function draw_number()
  seed = seed * 16807.0 % 2147483647.0
  return seed / 2147483647.0
end

local function draw(limit)
  return scale({draw_number(), draw_number(), draw_number()}, limit)
end

local function cell_of(location)
  return floor(location[1] / RADIUS) + ROW * floor(location[2] / RADIUS) + LAYER * floor(location[3] / RADIUS)
end

local function make_grid(boids)
  local grid = {}
  for _, boid in ipairs(boids) do
    local cell = cell_of(boid.location)
    local members = grid[cell]
    if members then
      members[#members + 1] = boid
    else
      grid[cell] = {boid}
    end
  end
  return grid
end

local function neighbors(grid, boid)
  local found = {}
  local location = boid.location
  local x, y, z = location[1], location[2], location[3]
  local middle = cell_of(location)
  for layer = middle - LAYER, middle + LAYER, LAYER do
    for row = layer - ROW, layer + ROW, ROW do
      for cell = row - 1, row + 1 do
        local members = grid[cell]
        if members then
          for _, other in ipairs(members) do
            local place = other.location
            local dx, dy, dz = place[1] - x, place[2] - y, place[3] - z
            if dx * dx + dy * dy + dz * dz < RADIUS * RADIUS and other ~= boid then found[#found + 1] = other end
          end
        end
      end
    end
  end
  return found
end

local Boid = {}
Boid.__index = Boid

function Boid:iterate(grid)
  local here, velocity = self.location, self.velocity
  local away, course, middle = {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}
  local mates = 0

  for _, mate in ipairs(neighbors(grid, self)) do
    local offset = sub(mate.location, here)
    local distance = norm(offset)
    away = sub(away, scale(offset, 1.0 / (distance * distance + 0.1)))
    course = add(course, mate.velocity)
    middle = add(middle, offset)
    mates = mates + 1
  end

  local urge = add(scale(away, 2.0), scale(sub(CENTER, here), 0.1))
  if mates > 0 then
    urge = add(urge, add(sub(scale(course, 1.0 / mates), velocity), scale(middle, 1.0 / mates)))
  end

  velocity = add(velocity, scale(urge, STEP))
  local speed = norm(velocity)
  if speed > 5.0 then velocity = scale(velocity, 5.0 / speed) end
  self.velocity = velocity
end

local boids = {}
for i = 1, 1000 do
  boids[i] = setmetatable({}, Boid)
end
for _, boid in ipairs(boids) do
  boid.location = draw(20.0)
  boid.velocity = sub(draw(4.0), {2.0, 2.0, 2.0})
end

for _ = 1, 50 do
  for _, boid in ipairs(boids) do boid.location = add(boid.location, scale(boid.velocity, STEP)) end
  local grid = make_grid(boids)
  for _, boid in ipairs(boids) do boid:iterate(grid) end
end

for _, boid in ipairs(boids) do print(string.format("%.6f %.6f %.6f", table.unpack(boid.location))) end
