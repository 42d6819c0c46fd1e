-- Vectors for the benchmarks: a vector is a table {x, y, z}, and each function makes a new one.
local vector = {}

function vector.add(a, b)
  return {a[1] + b[1], a[2] + b[2], a[3] + b[3]}
end

function vector.sub(a, b)
  return {a[1] - b[1], a[2] - b[2], a[3] - b[3]}
end

function vector.scale(a, s)
  return {a[1] * s, a[2] * s, a[3] * s}
end

function vector.cross(a, b)
  return {a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1]}
end

function vector.norm(a)
  return math.sqrt(a[1] * a[1] + a[2] * a[2] + a[3] * a[3])
end

-- As steve prints it.
function vector.text(a)
  return string.format("(%.5f, %.5f, %.5f)", a[1], a[2], a[3])
end

return vector
