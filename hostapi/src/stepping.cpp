// What a game loop needs beside steps: their length, the pace of time, poses in between.
#include <cmath>

#include "physical.hpp"
#include "rows.hpp"

namespace breve::host {

void PreviousPoses::record(const Bodies& bodies) {
  if (!on_) return;
  poses_.resize(bodies.index_end());
  for (BodyIndex body = 0; body < poses_.size(); ++body)
    poses_[body] =
        bodies.used(body) ? Entry{bodies.owner(body), {bodies.location(body), bodies.orientation(body)}} : Entry{};
}

namespace {

Pose between(const World& world, const PreviousPoses& previous, BodyIndex body, double fraction) {
  const Bodies& bodies = world.bodies();
  const Pose now{bodies.location(body), bodies.orientation(body)};
  const Pose* const before = previous.of(body, bodies.owner(body));
  if (!before || fraction == 1) return now;
  if (fraction == 0) return *before;
  const Vector3 way = world.space().offset(before->location, now.location);
  return {world.space().inside(before->location + fraction * way),
          before->orientation.slerp(fraction, now.orientation)};
}

}  // namespace
}  // namespace breve::host

using namespace breve::host;
using breve::BodyIndex;
using breve::Pose;

breve_status breve_world_set_iteration_step(breve_world* world, double seconds) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] { world->world->set_iteration_step(seconds); });
}

double breve_world_integration_step(const breve_world* world) { return world ? world->world->integration_step() : 0; }

breve_status breve_world_set_integration_step(breve_world* world, double seconds) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] { world->world->set_integration_step(seconds); });
}

double breve_world_time_scale(const breve_world* world) { return world ? world->time_scale : 0; }

breve_status breve_world_set_time_scale(breve_world* world, double scale) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (!std::isfinite(scale) || scale < 0) fail(BREVE_ERROR_ARGUMENT, "scale must be finite and >= 0");
    world->time_scale = scale;
  });
}

breve_status breve_world_set_interpolated(breve_world* world, bool on) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] { world->previous.keep(on); });
}

bool breve_world_interpolated(const breve_world* world) { return world && world->previous.kept(); }

breve_status breve_objects_interpolated(const breve_world* world, const breve_object* objects, size_t count,
                                        double fraction, uint32_t property, const breve_array* array) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (!(fraction >= 0 && fraction <= 1)) fail(BREVE_ERROR_ARGUMENT, "fraction must be from 0 to 1");
    const bool location = property == BREVE_PROPERTY_LOCATION || property == BREVE_PROPERTY_POSE;
    const bool orientation = property == BREVE_PROPERTY_ROTATION || property == BREVE_PROPERTY_POSE;
    if (!location && !orientation)
      fail(BREVE_ERROR_ARGUMENT,
           "property is " + std::to_string(property) + ": only locations, rotations and poses are known from before");
    if (!world->previous.kept())
      fail(BREVE_ERROR_ARGUMENT,
           "the poses of the last iteration are not kept: call breve_world_set_interpolated first");
    const std::size_t width = (location ? 3U : 0U) + (orientation ? 4U : 0U);
    const Rows rows(array, count, width);
    const auto all = bodies_of(*world, objects, count);
    double numbers[kMostNumbers];
    for (std::size_t i = 0; i < count; ++i) {
      const Pose pose = between(*world->world, world->previous, all[i], fraction);
      if (location) std::copy_n(pose.location.data(), 3, numbers);
      double* const q = numbers + (location ? 3 : 0);
      if (orientation) {
        q[0] = pose.orientation.w();
        std::copy_n(pose.orientation.vec().data(), 3, q + 1);
      }
      if (width == 3)
        rows.put<3>(i, numbers);
      else if (width == 4)
        rows.put<4>(i, numbers);
      else
        rows.put<7>(i, numbers);
    }
  });
}
