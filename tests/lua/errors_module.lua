-- Every function of the module that interpreters load raises an error; what it has and this file does not call is found.
local breve = require "breve"
local Field = breve.class("Field", "Control")
function Field:fail() error("on purpose") end
local Doomed = breve.class("Doomed", "Control")
function Doomed:init() error("at birth") end

local function fails(pattern, f, ...)
  local good, why = pcall(f, ...)
  assert(not good and type(why) == "string" and why:find(pattern), "expected an error like '" .. pattern .. "', got " .. tostring(why))
  local arguments = table.pack(...)
  good, why = coroutine.resume(coroutine.create(function() f(table.unpack(arguments, 1, arguments.n)) end))
  assert(not good and why:find(pattern), "in a coroutine: " .. tostring(why))
end

fails("table expected", breve.world, 5)
fails("number expected", breve.world, {seed = {}})
fails("class expected", breve.world, {controller = 5})
fails("there is no world yet", breve.time)
fails("there is no world yet", Field)
fails("table", breve.pairs, 5)
fails("defined twice", breve.class, "Field")

local world = breve.world{controller = Field}
local called = {
  step = function(w) world.step(w, {}) end,
  advance = function(w) world.advance(w, "long") end,
  ended = function(w) world.ended(w) end,
  hash = function(w) world.hash(w) end,
  snapshot = function(w) world.snapshot(w) end,
  restore = function(w) world.restore(w, "no image") end,
  use = function(w) world.use(w) end,
  controller = function(w) world.controller(w) end,
  close = function(w) world.close(w) end,
}
for name in pairs(debug.getmetatable(world)) do
  assert(called[name] or name:find("^__"), name .. " has no case")
end
for name, call in pairs(called) do
  fails("world expected", call, 5)
end
fails("number expected", called.step, world)
fails("number expected", called.advance, world)
fails("image", called.restore, world)
fails("on purpose", function() world:controller():fail() end)
fails("attempt to call a nil value", function() world:controller():nothing() end)
assert(world:step())
world:close()
for name, call in pairs(called) do
  if name ~= "close" then fails("the world is closed", call, world) end
end
fails("world expected", debug.getmetatable(world).__gc, {})

-- A class of an earlier program, which only the name of the controller brings into this one: its methods run, too.
fails("at birth", breve.world, {controller = "Doomed"})
local again <close> = breve.world{controller = "Field"}
assert(again:step() and again:controller():class_name() == "Field")
