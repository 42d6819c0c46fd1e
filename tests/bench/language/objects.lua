-- Create, call and drop 2e6 objects, one after another.
local Spark = {}
Spark.__index = Spark

function Spark.new()
  return setmetatable({heat = 1.0}, Spark)
end

function Spark:strike(force)
  self.heat = self.heat + force
end

function Spark:get_heat()
  return self.heat
end

local sum = 0.0
for i = 0, 1999999 do
  local spark = Spark.new()
  spark:strike(i)
  sum = sum + spark:get_heat()
end

print(string.format("%.6f", sum))
