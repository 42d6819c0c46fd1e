-- A method that overrides another calls it; init runs from the root class down.
local Animal = breve.class("Animal", "Mobile")
function Animal:init() print("animal") end
function Animal:pace() return 1 end
function Animal:iterate() self:set_velocity(breve.vector(self:pace(), 0, 0)) end
local Wolf = breve.class("Wolf", "Animal")
function Wolf:init() print("wolf") end
function Wolf:pace() return Wolf.super.pace(self) + 2 end
local Cub = breve.class("Cub", "Wolf")
function Cub:pace() return Cub.super.pace(self) * 10 end
local Main = breve.class("Main", "Control")
function Main:init() Animal() Wolf() Cub() end
breve.main(Main)
