// Natives of Terrain: a body whose shape is a height field of its own, and the heights in it.
#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/base/in_pieces.hpp"
#include "runtime/solid/height_grid.hpp"
#include "runtime/store/height_raster.hpp"
#include "steve/library/image_access.hpp"
#include "steve/library/resources.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

constexpr int kFirstSide = 33;

/// Heights of a square grid, as they are built up.
struct Heights {
  int side = 0;
  double tile = 1;
  std::vector<double> values;

  Heights(int points, const Poll& poll) : side(points) {
    resize_in_pieces(values, static_cast<std::size_t>(points) * static_cast<std::size_t>(points), poll);
  }
  double& at(int column, int row) {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(side) + static_cast<std::size_t>(column)];
  }
};

const std::shared_ptr<Shape>& shape_of(Machine& machine, Instance& self) {
  const ShapeResource* resource = resource_of<ShapeResource>(machine, &self);
  if (!resource || !resource->shape)
    Machine::fail(RunErrorKind::NullObject, name_of(self) + " has no heights (its init did not run)");
  return resource->shape;
}

/// What the natives rely on: a square height field with 2^n + 1 points a side. An archive may hold any shape.
const HeightGrid* square_grid(const Shape& shape) {
  const HeightGrid* grid = shape.heights();
  const int cells = grid ? grid->columns() - 1 : 0;
  return grid && grid->rows() == grid->columns() && cells > 0 && (cells & (cells - 1)) == 0 ? grid : nullptr;
}

const HeightGrid& grid_of(Machine& machine, Instance& self) {
  const HeightGrid* grid = square_grid(*shape_of(machine, self));
  if (!grid) Machine::fail(RunErrorKind::Type, name_of(self) + " holds a shape that is not a square height field");
  return *grid;
}

void use(Machine& machine, Instance& self, const std::shared_ptr<Shape>& shape) {
  Bodies& bodies = machine.world().bodies();
  const BodyIndex body = body_of(machine, self);
  bodies.set_collision_shape(body, shape);
  bodies.set_display_shape(body, shape);
}

void charge_for_points(Machine& machine, std::uint64_t side) {
  constexpr std::uint64_t kOfPoint = 8;
  machine.charge_for(kOfPoint * side * side);
}

void set_heights(Machine& machine, Instance& self, const Heights& heights) {
  auto shape = Shape::height_field(heights.side, heights.side, heights.tile, heights.values, machine.heap().memory(),
                                   machine.poller());
  use(machine, self, shape);
  resource_made<ShapeResource>(machine, self).shape = std::move(shape);
}

Heights copy_of(const Machine& machine, const HeightGrid& grid) {
  Heights heights(grid.columns(), machine.poller());
  heights.tile = grid.tile();
  for (int row = 0; row < heights.side; ++row) {
    for (int column = 0; column < heights.side; ++column) heights.at(column, row) = grid.height(column, row);
    machine.poller()();
  }
  return heights;
}

bool in(const HeightGrid& grid, std::int32_t column, std::int32_t row) {
  return column >= 0 && row >= 0 && column < grid.columns() && row < grid.rows();
}

// --- natives --------------------------------------------------------------------------------------------------------

void terrain_init(Machine& machine, Instance& self) {
  embody(machine, self, BodyKind::Stationary);
  set_heights(machine, self, Heights(kFirstSide, machine.poller()));
}

void terrain_dearchive(Machine& machine, Instance& self) {
  const std::shared_ptr<Shape>& shape = shape_of(machine, self);
  if (!square_grid(*shape))
    throw Error(ErrorCode::File, "the archive is damaged: a Terrain holds a shape that is not a square height field");
  use(machine, self, shape);
}

/// Midpoint displacement: squares get their middles, then edges theirs, level by level.
void displace(Heights& heights, double factor, Random& random, const Poll& poll) {
  const int last = heights.side - 1;
  double reach = 1;
  for (int step = last; step > 1; step /= 2, reach *= factor) {
    const int half = step / 2;
    const auto offset = [&] { return (random.uniform() - 0.5) * reach; };
    for (int z = half; z < last; z += step, poll())
      for (int x = half; x < last; x += step)
        heights.at(x, z) = offset() + (heights.at(x - half, z - half) + heights.at(x + half, z - half) +
                                       heights.at(x - half, z + half) + heights.at(x + half, z + half)) /
                                          4;
    for (int z = 0; z <= last; z += half, poll())
      for (int x = (z / half) % 2 == 0 ? half : 0; x <= last; x += step) {
        double sum = 0;
        int count = 0;
        for (const auto& [dx, dz] : {std::pair{-half, 0}, {half, 0}, {0, -half}, {0, half}}) {
          if (x + dx < 0 || x + dx > last || z + dz < 0 || z + dz > last) continue;
          sum += heights.at(x + dx, z + dz);
          ++count;
        }
        heights.at(x, z) = offset() + sum / count;
      }
  }
}

void terrain_generate(Machine& machine, Instance& self, double ruggedness, double height) {
  finite(ruggedness, "generate: the ruggedness");
  finite(height, "generate: the height");
  const HeightGrid& grid = grid_of(machine, self);
  const int side = 2 * (grid.columns() - 1) + 1;
  if (side > HeightGrid::kMostSide)
    throw Error(ErrorCode::Argument, "generate: the grid has " + std::to_string(grid.columns()) +
                                         " points per side and cannot be doubled again");
  charge_for_points(machine, static_cast<std::uint64_t>(side));
  Heights heights(side, machine.poller());
  heights.tile = grid.tile();
  const double grown = (grid.columns() - 1) * grid.tile() / 2;
  displace(heights, std::pow(2.0, -(1 - ruggedness)), machine.world().random(), machine.poller());
  in_pieces(heights.values.size(), sizeof(double), machine.poller(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) heights.values[i] *= height;
  });
  set_heights(machine, self, heights);
  Bodies& bodies = machine.world().bodies();
  const BodyIndex body = body_of(machine, self);
  // A flat world sees the middle row, which has no low corner along z.
  const double along_z = machine.world().dimension() == 2 ? 0 : grown;
  bodies.set_location(body, bodies.location(body) + Vector3(grown, 0, along_z));
}

void terrain_set_height(Machine& machine, Instance& self, std::int32_t column, std::int32_t row, double height) {
  finite(height, "set-height: the height");
  if (!in(grid_of(machine, self), column, row)) return;
  constexpr std::uint64_t kOfHeight = 64;  // loop iterations: the bounds of the squares around it, and of those above
  machine.charge(kOfHeight);
  const std::shared_ptr<Shape>& shape = shape_of(machine, self);
  shape->set_height(column, row, height);
  use(machine, self, shape);  // its bounds may be others
}

double terrain_get_height(Machine& machine, Instance& self, std::int32_t column, std::int32_t row) {
  const HeightGrid& grid = grid_of(machine, self);
  return in(grid, column, row) ? grid.height(column, row) : 0;
}

double terrain_height_in_world(Machine& machine, Instance& self, double x, double z) {
  finite(x, "get-height-in-world: x");
  finite(z, "get-height-in-world: z");
  const HeightGrid& grid = grid_of(machine, self);
  const Vector3& location = machine.world().bodies().location(body_of(machine, self));
  const double middle = (grid.columns() - 1) / 2.0;
  const double column = std::floor((x - location.x()) / grid.tile() + middle);
  const double row = std::floor((z - location.z()) / grid.tile() + middle);
  if (column < 0 || row < 0) return 0;
  const double last = grid.columns() - 1;
  return location.y() + grid.height(static_cast<int>(std::fmin(column, last)), static_cast<int>(std::fmin(row, last)));
}

std::int32_t terrain_get_size(Machine& machine, Instance& self) { return grid_of(machine, self).columns(); }

void terrain_set_scale(Machine& machine, Instance& self, double tile) {
  finite(tile, "set-scale: the tile size");
  constexpr double kSmallest = 0.001;
  if (tile < kSmallest) return;
  charge_for_points(machine, static_cast<std::uint64_t>(grid_of(machine, self).columns()));
  Heights heights = copy_of(machine, grid_of(machine, self));
  heights.tile = tile;
  set_heights(machine, self, heights);
}

/// The brightness of a picture at a place in pixels, between their centres linearly. 0 ... 1
double brightness(const Image& picture, double x, double y) {
  const auto level = [&](int column, int row) {
    const int inside_x = std::clamp(column, 0, picture.width() - 1),
              inside_y = std::clamp(row, 0, picture.height() - 1);
    return (picture.get(inside_x, inside_y, Channel::Red) + picture.get(inside_x, inside_y, Channel::Green) +
            picture.get(inside_x, inside_y, Channel::Blue)) /
           3;
  };
  const double left = std::floor(x), top = std::floor(y), across = x - left, down = y - top;
  const int column = static_cast<int>(left), row = static_cast<int>(top);
  return (1 - down) * ((1 - across) * level(column, row) + across * level(column + 1, row)) +
         down * ((1 - across) * level(column, row + 1) + across * level(column + 1, row + 1));
}

/// Heights out of a table of columns x rows that is stretched over the whole terrain.
/// @param height_at  (column, row), also between the cells of the table
template <class HeightAt>
void set_heights_from(Machine& machine, Instance& self, int columns, int rows, HeightAt&& height_at) {
  const HeightGrid& grid = grid_of(machine, self);
  charge_for_points(machine, static_cast<std::uint64_t>(grid.columns()));
  Heights heights(grid.columns(), machine.poller());
  heights.tile = grid.tile();
  const double last = heights.side - 1;
  for (int row = 0; row < heights.side; ++row) {
    for (int column = 0; column < heights.side; ++column)
      heights.at(column, row) = height_at(column * (columns - 1) / last, row * (rows - 1) / last);
    machine.poll();
  }
  set_heights(machine, self, heights);
}

void terrain_heights_from_image(Machine& machine, Instance& self, Instance* source, double height) {
  finite(height, "set-heights: the height");
  const Image& picture = image_of(machine, source, "set-heights: the image");
  if (picture.empty()) throw Error(ErrorCode::Argument, "set-heights: the image has no pixels");
  set_heights_from(machine, self, picture.width(), picture.height(),
                   [&](double column, double row) { return height * brightness(picture, column, row); });
}

/// One pass of weights 1, 2, 1 along rows or columns; at the rim the point itself stands for what is beyond.
void smooth_once(Heights& heights, int right, int down, const Poll& poll) {
  const Heights before = heights;
  const auto at = [&](int column, int row) {
    const int last = before.side - 1;
    return before.values[static_cast<std::size_t>(std::clamp(row, 0, last)) * static_cast<std::size_t>(before.side) +
                         static_cast<std::size_t>(std::clamp(column, 0, last))];
  };
  for (int row = 0; row < heights.side; ++row, poll())
    for (int column = 0; column < heights.side; ++column)
      heights.at(column, row) =
          (at(column - right, row - down) + 2 * at(column, row) + at(column + right, row + down)) / 4;
}

void terrain_smooth(Machine& machine, Instance& self, std::int32_t passes) {
  constexpr std::int32_t kMostPasses = 1000;
  if (passes < 0 || passes > kMostPasses)
    throw Error(ErrorCode::Argument, "smooth: " + std::to_string(passes) + " passes (must be 0 to 1000)");
  charge_for_points(machine, static_cast<std::uint64_t>(grid_of(machine, self).columns()));  // of the copy
  Heights heights = copy_of(machine, grid_of(machine, self));
  for (std::int32_t i = 0; i < passes; ++i) {
    charge_for_points(machine, static_cast<std::uint64_t>(heights.side));
    smooth_once(heights, 1, 0, machine.poller());
    smooth_once(heights, 0, 1, machine.poller());
  }
  set_heights(machine, self, heights);
}

void terrain_load_geo_tiff(Machine& machine, Instance& self, Text file) {
  const std::string name(view(file));
  const std::pmr::string bytes = read_file(machine, name);
  machine.charge(bytes.size());  // a loop iteration for each byte
  const HeightRaster raster = HeightRaster::parse_geo_tiff(bytes, name, machine.poller());
  set_heights_from(machine, self, raster.columns, raster.rows,
                   [&](double column, double row) { return raster.at(column, row); });
}

constexpr Native kTerrainNatives[] = {
    native<terrain_init>("terrain.init"),
    native<terrain_dearchive>("terrain.dearchive"),
    native<terrain_generate>("terrain.generate"),
    native<terrain_set_height>("terrain.set-height"),
    native<terrain_get_height>("terrain.get-height"),
    native<terrain_height_in_world>("terrain.get-height-in-world"),
    native<terrain_get_size>("terrain.get-size"),
    native<terrain_set_scale>("terrain.set-scale"),
    native<terrain_heights_from_image>("terrain.set-heights"),
    native<terrain_smooth>("terrain.smooth"),
    native<terrain_load_geo_tiff>("terrain.load-geo-tiff"),
};

}  // namespace

std::span<const Native> terrain_natives() { return kTerrainNatives; }

}  // namespace breve::steve
