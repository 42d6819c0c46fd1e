-- `require "breve"` in an interpreter: two worlds, stepping, snapshots, errors.
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

local Other = breve.class("Other", "Control")
local second <close> = breve.world{controller = Other}
assert(second:step(2))
print("ok")
