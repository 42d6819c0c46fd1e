-- A call of each function of the binding that must raise an error. `unlisted` walks what a script can reach of the
-- binding, so that a function without a case is found. errors.c runs each case in several ways.
local Bird = breve.class("Bird", "Mobile")
function Bird:init() self:set_neighborhood_size(5) end
function Bird:pair(first, second) error("pair of " .. first .. second) end

local Broken = breve.class("Broken", "Mobile")
function Broken:init() error("never made") end

local Main = breve.class("Main", "Base")
breve.main(Main)

local v, m = breve.vector(1, 2, 3), breve.matrix(1)
local meta = debug.getmetatable
local loud = setmetatable({}, {__tostring = function() error("no text") end})

-- Name -> a function that is given a bird. Each must raise an error.
local cases = {
  ["breve.class"] = function() breve.class("Unknown") end,
  ["breve.main"] = function() breve.main(5) end,
  ["breve.use"] = function() breve.use({}) end,
  ["breve.new"] = function() breve.new("Nobody") end,
  ["a negative count"] = function() breve.new("Bird", -1) end,
  ["breve.free"] = function() breve.free(5) end,
  ["breve.is_a"] = function() breve.is_a(5, "Bird") end,
  ["breve.class_name"] = function() breve.class_name({}) end,
  ["breve.get"] = function(bird) breve.get(bird, "nothing") end,
  ["breve.set"] = function(bird) breve.set(bird, "nothing", print) end,
  ["breve.objects"] = function() breve.objects("Nobody") end,
  ["breve.random"] = function() breve.random("five") end,
  ["breve.on_save"] = function() breve.on_save(5) end,
  ["breve.on_load"] = function() breve.on_load() end,
  ["breve.vector"] = function() breve.vector("one") end,
  ["breve.matrix"] = function() breve.matrix(1, 2, {}) end,

  ["vector.__add"] = function() return v + 1 end,
  ["vector.__sub"] = function() return {} - v end,
  ["vector.__mul"] = function() return v * v end,
  ["vector.__div"] = function() return 1 / v end,
  ["vector.__unm"] = function() meta(v).__unm(5) end,
  ["vector.__tostring"] = function() meta(v).__tostring(m) end,
  ["vector.__newindex"] = function() v.x = 1 end,
  ["vector.__index"] = function() meta(v).__index(5, "x") end,
  ["vector.length"] = function() v.length(m) end,
  ["vector.dot"] = function() v:dot(1) end,
  ["vector.cross"] = function() v:cross() end,
  ["vector.unit"] = function() v.unit("v") end,
  ["vector.unpack"] = function() v.unpack({1, 2, 3}) end,
  ["matrix.__index"] = function() meta(m).__index(v, 1) end,
  ["matrix.__tostring"] = function() meta(m).__tostring(v) end,
  ["matrix.__newindex"] = function() m[1] = 2 end,

  ["class.__newindex"] = function() Main.count = 5 end,
  ["class.__call"] = function() Broken() end,
  ["super.__index"] = function() return Bird.super[{}] end,

  ["object.free"] = function(bird) bird.free(5) end,
  ["object.is_a"] = function(bird) bird:is_a(5) end,
  ["object.class_name"] = function(bird) bird.class_name(v) end,
  ["object.neighbors"] = function(bird) bird.neighbors("bird") end,
  ["object.pair"] = function(bird) bird:pair{first = 1, second = 2} end,
  ["object.selector"] = function(bird) bird:set_velocity("fast") end,
  ["too many arguments"] = function(bird) bird:set_velocity(v, v) end,
  ["missing keyword"] = function(bird) bird:handle_collisions{with_type = "Bird"} end,
  ["value without a form"] = function(bird) bird:set_velocity(print) end,
  ["value that holds itself"] = function(bird) local t = {} t[1] = t bird:set_velocity(t) end,
  ["receiver that is gone"] = function(bird) bird:free() bird:get_location() end,
  ["receiver that is none"] = function(bird) bird.get_location(5) end,
  ["super of another class"] = function(bird) Main.super.iterate(bird) end,
  ["method of super"] = function(bird) Bird.super.set_velocity(bird, {1}) end,
  ["field of an unfinished object"] = function() Bird{[{}] = 1, age = error("in a field")} end,
  ["steve method"] = function() breve.controller():divide() end,
  ["steve method that calls Lua"] = function() breve.controller():back() end,

  ["print"] = function() print(loud) end,
  ["tostring"] = function() tostring(loud) end,
  ["select"] = function() select(0) end,
  ["tonumber"] = function() tonumber() end,
  ["math.max"] = function() math.max() end,
  ["math.min"] = function() math.min() end,
  ["string.byte"] = function() string.byte({}) end,
  ["string.char"] = function() string.char(-1) end,
  ["string.find"] = function() string.find("x", "[") end,
  ["string.gmatch"] = function() for _ in string.gmatch("x", "%") do end end,
  ["string.gsub"] = function() string.gsub("x", "x", loud and true) end,
  ["string.match"] = function() string.match("x", "(x") end,
  ["string.pack"] = function() string.pack("i4", "x") end,
  ["string.packsize"] = function() string.packsize("?") end,
  ["string.rep"] = function() string.rep({}) end,
  ["string.unpack"] = function() string.unpack("i4", "") end,
  ["table.concat"] = function() table.concat({{}}) end,
  ["table.insert"] = function() table.insert({}) end,
  ["table.move"] = function() table.move(1) end,
  ["table.remove"] = function() table.remove({}, 5) end,
  ["table.sort"] = function() table.sort({1, "a"}) end,
  ["table.unpack"] = function() table.unpack(5) end,
  ["utf8.char"] = function() utf8.char(-1) end,
  ["utf8.codepoint"] = function() utf8.codepoint("", 1) end,
  ["utf8.len"] = function() utf8.len({}) end,
  ["utf8.offset"] = function() utf8.offset("x", {}) end,
  ["string.format"] = function() string.format("%s", loud) end,
  ["math.random"] = function() math.random(2, 1) end,
  ["math.randomseed"] = function() math.randomseed(1) end,
  ["load"] = function() load(print) end,
  ["setmetatable"] = function() setmetatable({}, {__gc = print}) end,
  ["require"] = function() require("nowhere") end,
  ["pairs"] = function() for _ in pairs({[{}] = 1}) do end end,
  ["next"] = function() next({a = 1}, "b") end,
}

-- What raises an error only where there is no world (errors.c tries that), or never.
local quiet = {["breve.alive"] = 1, ["breve.controller"] = 1, ["breve.time"] = 1, ["breve.iteration"] = 1,
  ["vector.__eq"] = 1, ["matrix.__eq"] = 1, ["class.__index"] = 1, ["object.__tostring"] = 1}

local names = {}
for name in pairs(cases) do names[#names + 1] = name end

function Main:count() return #names end
function Main:name_of(number) return names[number] end

-- An error that nobody catches: errors.c sees its status.
function Main:fail(number) cases[names[number]](Bird()) return 0 end

-- Caught in a pcall, in a coroutine, behind a method in steve and in xpcall: each time there is a text.
function Main:catch(number)
  local run = function() cases[names[number]](Bird()) end
  local good, why = pcall(run)
  if good or type(why) ~= "string" or why == "" then return "pcall: " .. tostring(why) end
  local thread = coroutine.create(run)
  good, why = coroutine.resume(thread)
  if good or type(why) ~= "string" then return "coroutine: " .. tostring(why) end
  good, why = pcall(self.through_steve, self, number)
  if good or type(why) ~= "string" then return "steve: " .. tostring(why) end
  good, why = xpcall(run, function(text) return "handled " .. text end)
  if good or not why:find("^handled ") then return "xpcall: " .. tostring(why) end
  return ""
end

-- C functions of a table, whatever hides it.
local function add(found, prefix, t)
  for key, value in pairs(t) do
    local binding = type(value) == "function" and debug.getinfo(value, "S").what == "C"
    if binding and type(key) == "string" then found[prefix .. key] = true end
  end
end

-- Tables that a function of the binding keeps for itself.
local function add_kept(found, prefix, f)
  for i = 1, 9 do
    local _, kept = debug.getupvalue(f, i)
    if type(kept) == "table" and kept ~= meta(v) and kept ~= meta(m) then add(found, prefix, kept) end
  end
end

function Main:unlisted()
  local found, bird, text = {}, Bird(), ""
  add(found, "breve.", breve)
  add(found, "vector.", meta(v))
  add_kept(found, "vector.", meta(v).__index)
  add(found, "matrix.", meta(m))
  add(found, "class.", meta(Bird))
  add(found, "super.", meta(Bird.super))
  for _, key in ipairs{"__index", "__newindex", "__call", "__tostring", "__eq", "__lt", "__len", "__gc", "__pairs"} do
    add(found, "object.", {[key] = meta(bird)[key]}) -- its mark is a key that pairs refuses
  end
  local selectors = 0
  for key in pairs(meta(bird).__index) do
    if cases["object." .. key] then found["object." .. key] = true else selectors = selectors + 1 end
  end
  if selectors < 50 then text = "hardly any selector " end
  for name in pairs(found) do
    if not cases[name] and not quiet[name] then text = text .. name .. " " end
  end
  for name in pairs(cases) do
    if name:find("^%l+%.__") and not found[name] then text = text .. "nothing is called " .. name .. " " end
  end
  return text
end

function Main:has_case(name) return cases[name] ~= nil end

-- What is quiet stays so, whatever it is given.
function Main:quiet_ones()
  return meta(v).__eq(5, {}) == false and meta(m).__eq(nil, m) == false and breve.alive(print) == false
    and Main.nothing == nil and meta(self).__tostring({}) == "an object that is gone" and v[{}] == nil
end
