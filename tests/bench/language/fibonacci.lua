-- Fibonacci(30) by recursion through a method.
local Bench = {}
Bench.__index = Bench

function Bench:fibonacci(n)
  if n < 2 then return n end
  return self:fibonacci(n - 1) + self:fibonacci(n - 2)
end

local bench = setmetatable({}, Bench)
print(bench:fibonacci(30))
