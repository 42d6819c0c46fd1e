-- `require "breve"` in an interpreter: worlds of one program and of several, stepping, snapshots, errors.
local breve = require "breve"

local Walker = breve.class("Walker", "Mobile")
function Walker:init() self.steps = 0 self:set_velocity(breve.vector(1, 0, 0)) end
function Walker:iterate() self.steps = self.steps + 1 end

local Field = breve.class("Field", "Control")
function Field:init() self.walker = Walker() self:set_iteration_step(1) self:set_integration_step(1) end
function Field:steps() return self.walker.steps end
function Field:fail() error("on purpose") end

local world = breve.world{controller = Field, seed = 3}
local image, hash = world:snapshot(), world:hash()
assert(world:step(4))
assert(world:controller():steps() == 4)
assert(world:controller().walker:get_location() == breve.vector(4, 0, 0))
world:restore(image)
assert(world:hash() == hash and world:controller():steps() == 0)
local good, why = pcall(function() world:controller():fail() end)
assert(not good and why:find("on purpose"))
assert(not pcall(breve.world, {controller = 5}))
assert(not pcall(world.step, 5))
assert(not world:ended())
world:close()
assert(not pcall(world.step, world))

-- Worlds of one program: it is kept, and each world has all classes.
local Sheep = breve.class("Sheep", "Mobile")
function Sheep:legs() return 4 end
local Meadow = breve.class("Meadow", "Control")
function Meadow:init() self.sheep = breve.new("Sheep", 2) end
function Meadow:legs() return #self.sheep * self.sheep[1]:legs() end
for seed = 1, 3 do
  local meadow <close> = breve.world{controller = Meadow, seed = seed}
  assert(meadow:step() and meadow:controller():legs() == 8)
end
local one, two = breve.world{controller = Meadow}, breve.world{controller = Meadow}
assert(one:controller():legs() == 8 and two:controller():legs() == 8 and one:hash() == two:hash())
assert(one:step(2) and two:step(2) and one:hash() == two:hash())

-- A class that is added later is derived from an earlier one; a method that is set anew is that of the next world.
local Lamb = breve.class("Lamb", Sheep)
function Lamb:weight() return 5 end
function Sheep:legs() return 3 end
function Meadow:lamb() local lamb = Lamb() return lamb:legs() * lamb:weight() end
local third = breve.world{controller = Meadow}
assert(third:controller():lamb() == 15 and third:controller():legs() == 6)
assert(one:controller():legs() == 8 and one:step() and two:step() and third:step())
one:close() two:close() third:close()

-- A class is defined anew between two programs, with another parent, and twice in none.
Lamb = breve.class("Lamb", "Mobile")
function Lamb:legs() return 2 end
function Lamb:weight() return 1 end
assert(not pcall(breve.class, "Lamb", "Mobile"))
local fourth = breve.world{controller = Meadow}
assert(fourth:controller():lamb() == 2)
fourth:close()

-- A program that does not compile leaves the classes as they are.
breve.class("Orphan", "Nobody")
local made, cause = pcall(breve.world, {controller = Meadow})
assert(not made and cause:find("Nobody"), cause)
breve.class("Orphan", "Mobile")
breve.world{controller = Meadow}:close()

-- What a world is made with.
local function refused(config, ...)
  local done, said = pcall(breve.world, config)
  for _, part in ipairs{...} do assert(not done and said:find(part, 1, true), said) end
end
refused({controller = Meadow, sed = 3}, "no field 'sed'", "did you mean 'seed'?")
refused({controller = Meadow, zeal = 3, colour = 1}, "no field 'colour'", "memory_limit, depth_limit")
refused({Meadow}, "by name")
refused({seed = "one"}, "seed of breve.world: number expected, got string")
refused({seed = 1.5}, "whole number")
refused({budget = -1}, "budget of breve.world is -1, and must be from 0")
refused({depth_limit = 2 ^ 40}, "must be from 0 to 4294967295")
refused({iteration_step = 0 / 0}, "finite")
refused({strict = 1}, "boolean expected")
refused({accuracy = "perfect"}, "perfect")
refused({arguments = "a"}, "table expected")
refused({arguments = {"a", 1}}, "number 2 is not a text")
refused({controller = Meadow, memory_limit = 1000}, "memory")
local settings = {controller = Meadow, seed = -1, arguments = {"meadow", "green"}, budget = 1000, call_budget = 1000,
  physics_budget = 1000000, memory_limit = 1 << 28, depth_limit = 100, nesting_limit = 10, advance_limit = 2, dimension = 3,
  iteration_step = 0.5, integration_step = 0.25, length_unit = 1, patience = 0, accuracy = "fast", strict = true,
  verbose = false, coarse_random = true}
local fifth <close> = breve.world(settings)
assert(fifth:step(2) and fifth:controller():get_time() == 1)
assert(fifth:controller():get_argument(1) == "green")
local Crowd = breve.class("Crowd", "Control")
function Crowd:init() breve.new("Sheep", 2000) end
breve.world{controller = Crowd, budget = 100000}:close()
refused({controller = Crowd, budget = 1000}, "used up its budget")

local Other = breve.class("Other", "Control")
local second <close> = breve.world{controller = Other}
assert(second:step(2))
print("ok")
