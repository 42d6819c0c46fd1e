// Small scenes with a smooth solution: see convergence_scenes.hpp.
#include "convergence_scenes.hpp"

#include <cmath>

#include "scenes.hpp"

namespace breve::reference {

namespace {

constexpr double kGravity = 9.81;

Solid cylinder(double radius, double height, double mass) {
  Solid out;
  out.geometry.kind = BREVE_SHAPE_CYLINDER;
  out.geometry.radius = radius;
  out.geometry.height = height;
  out.mass = mass;
  return out;
}

Solid capsule(double radius, double height, double mass) {
  Solid out = cylinder(radius, height, mass);
  out.geometry.kind = BREVE_SHAPE_CAPSULE;
  return out;
}

Quaternion about(const Vector3& axis, double angle) { return Quaternion(Eigen::AngleAxisd(angle, axis)); }

breve_object floor_of(World& world, double tilt, double friction) {
  const breve_object floor = incline(world, tilt);
  world.set_material(floor, friction, 0);
  return floor;
}

/// How far a body has come along a direction.
Read along_of(breve_object body, const Vector3& direction, const Vector3& from) {
  return [=](const World& world) { return std::vector<double>{direction.dot(world.at(body) - from)}; };
}

Read place_of(breve_object body) {
  return [=](const World& world) {
    const Vector3 at = world.at(body);
    return std::vector<double>{at.x(), at.y(), at.z()};
  };
}

Read angles_of(const std::vector<breve_object>& joints) {
  return [=](const World& world) {
    std::vector<double> out;
    for (const breve_object joint : joints) out.push_back(world.read(joint).position[0]);
    return out;
  };
}

void drive(World& world, breve_object joint, double speed, double strength) {
  breve_drive drive = world.drive(joint);
  drive.motor_speed[0] = speed;
  drive.strength_limit = strength;
  world.set_drive(joint, drive);
}

// --- contacts that slide and stick ------------------------------------------------------------------------------------

struct Slide {
  double tilt, friction, speed;  // up the slope
};

Read block_on_slope(World& world, const Slide& slide) {
  floor_of(world, slide.tilt, slide.friction);
  const Vector3 at = 0.1 * across(slide.tilt);
  const breve_object block = world.body(box(Vector3(0.2, 0.2, 0.2), 1), at, about(Vector3::UnitZ(), slide.tilt));
  world.set_material(block, slide.friction, 0);
  world.set_velocity(block, slide.speed * along(slide.tilt));
  return along_of(block, along(slide.tilt), at);
}

/// How far it has come up the slope: uphill until it stops, then downhill if friction does not hold it.
double slid(const Slide& slide, double t) {
  const double pull = kGravity * std::sin(slide.tilt), rub = slide.friction * kGravity * std::cos(slide.tilt);
  const double sign = slide.speed < 0 ? -1 : 1, slowing = pull + sign * rub, stop = slide.speed / slowing;
  if (stop > t) return slide.speed * t - 0.5 * slowing * t * t;
  const double down = std::max(0.0, pull - rub);
  return 0.5 * slide.speed * stop - 0.5 * down * (t - stop) * (t - stop);
}

Scene sliding(const char* name, Slide slide, Motion motion) {
  Scene scene{name, 0.5, motion};
  scene.variants = 8;
  const auto vary = [slide](int i) {
    Slide out = slide;
    out.speed *= 1 + 0.013 * i;
    return out;
  };
  scene.build = [vary](World& world, int i) { return block_on_slope(world, vary(i)); };
  scene.exact = [vary](double t, int i) { return std::vector<double>{slid(vary(i), t)}; };
  return scene;
}

Scene conveyor() {
  constexpr double kBelt = 0.5, kFriction = 0.3;
  Scene scene{"a belt takes a block along", 0.5, Motion::Straight};
  scene.variants = 8;
  const auto belt = [](int i) { return kBelt * (1 + 0.017 * i); };
  scene.build = [belt](World& world, int i) {
    const breve_object floor = floor_of(world, 0, kFriction);
    world.set_velocity(floor, Vector3(belt(i), 0, 0));
    const Vector3 at(0, 0.1, 0);
    const breve_object block = world.body(box(Vector3(0.2, 0.2, 0.2), 1), at);
    world.set_material(block, kFriction, 0);
    return along_of(block, Vector3::UnitX(), at);
  };
  scene.exact = [belt](double t, int i) {
    const double pull = kFriction * kGravity, stick = std::min(t, belt(i) / pull);
    return std::vector<double>{0.5 * pull * stick * stick + belt(i) * (t - stick)};
  };
  return scene;
}

/// A spring pulls a block over a rough floor until it turns, where friction holds it.
Scene spring_on_floor() {
  constexpr double kStiffness = 30, kFriction = 0.3, kMass = 1, kLength = 0.5;
  Scene scene{"a spring pulls a block, friction stops it", 0.75, Motion::Straight};
  scene.variants = 8;
  const auto stretch = [](int i) { return 0.17 * (1 + 0.009 * i); };
  scene.build = [stretch](World& world, int i) {
    floor_of(world, 0, kFriction);
    const breve_object post = world.fixed(box(Vector3(0.1, 0.1, 0.1), 1), Vector3(-kLength, 0.1, 0));
    const Vector3 at(0, 0.1, 0);
    const breve_object block = world.body(box(Vector3(0.2, 0.2, 0.2), kMass), at + Vector3(stretch(i), 0, 0));
    world.set_material(block, kFriction, 0);
    breve_spring spring = breve_spring_default();
    spring.from = post, spring.to = block;
    spring.length = kLength, spring.strength = kStiffness, spring.damping = 0;
    breve_object made{};
    world.must(breve_spring_create(world.get(), &spring, &made));
    return along_of(block, Vector3::UnitX(), at);
  };
  scene.exact = [stretch](double t, int i) {
    const double rub = kFriction * kGravity * kMass / kStiffness, rate = std::sqrt(kStiffness / kMass);
    return std::vector<double>{rub + (stretch(i) - rub) * std::cos(std::min(rate * t, kPi))};
  };
  return scene;
}

/// A thin capsule slides down between a wall and a floor without friction.
Scene ladder() {
  constexpr double kHalf = 1, kRadius = 0.05, kLean = 0.4;
  Scene scene{"a ladder slides down a wall", 0.5, Motion::Curved};
  scene.build = [](World& world, int) {
    floor_of(world, 0, 0);
    const breve_object wall = world.fixed(box(Vector3(10, 20, 20), 1), Vector3(-5, 0, 0));
    const breve_object rod =
        world.body(capsule(kRadius, 2 * kHalf, 3),
                   Vector3(kRadius + kHalf * std::sin(kLean), kRadius + kHalf * std::cos(kLean), 0),
                   about(Vector3::UnitZ(), kLean));
    world.set_material(wall, 0, 0);
    world.set_material(rod, 0, 0);
    return place_of(rod);
  };
  return scene;
}

// --- contacts that roll -----------------------------------------------------------------------------------------------

Scene rolling(const char* name, const Solid& solid, double share, bool flat = false) {
  constexpr double kTilt = 0.3;
  Scene scene{name, 0.5, flat ? Motion::Flat : Motion::Straight};
  scene.build = [solid, flat](World& world, int) {
    floor_of(world, kTilt, 0.8);
    const Vector3 at = 0.25 * across(kTilt);
    // In a flat world a cylinder is a disc as it is.
    const Quaternion lying = flat ? Quaternion::Identity() : about(Vector3::UnitX(), kPi / 2);
    const breve_object body = world.body(solid, at, lying);
    world.set_material(body, 0.8, 0);
    return along_of(body, -along(kTilt), at);
  };
  scene.exact = [share](double t, int) {
    return std::vector<double>{0.5 * share * kGravity * std::sin(kTilt) * t * t};
  };
  return scene;
}

Scene skidding() {
  constexpr double kFriction = 0.2;
  Scene scene{"a ball skids until it rolls", 0.5, Motion::Straight};
  scene.variants = 8;
  const auto speed = [](int i) { return 2 * (1 + 0.011 * i); };
  scene.build = [speed](World& world, int i) {
    floor_of(world, 0, kFriction);
    const Vector3 at(0, 0.25, 0);
    const breve_object ball = world.body(sphere(0.25, 1), at);
    world.set_material(ball, kFriction, 0);
    world.set_velocity(ball, Vector3(speed(i), 0, 0));
    return along_of(ball, Vector3::UnitX(), at);
  };
  scene.exact = [speed](double t, int i) {
    const double slowing = kFriction * kGravity, rolls = std::min(t, 2 * speed(i) / (7 * slowing));
    return std::vector<double>{speed(i) * rolls - 0.5 * slowing * rolls * rolls + 5.0 / 7 * speed(i) * (t - rolls)};
  };
  return scene;
}

Scene ball_over_ball() {
  Scene scene{"a ball rolls over a ball", 0.5, Motion::Curved};
  scene.build = [](World& world, int) {
    const breve_object below = world.fixed(sphere(1, 1), Vector3::Zero());
    const breve_object ball = world.body(sphere(0.25, 1), 1.25 * Vector3(std::sin(0.3), std::cos(0.3), 0));
    world.set_material(below, 3, 0);
    world.set_material(ball, 3, 0);
    return place_of(ball);
  };
  return scene;
}

Scene uneven_ball() {
  Scene scene{"a ball of uneven mass rolls", 0.5, Motion::Curved};
  scene.build = [](World& world, int) {
    floor_of(world, 0, 3);
    Solid solid = sphere(0.25, 1);
    solid.inertia = Vector3(0.01, 0.02, 0.025).asDiagonal();
    const breve_object ball = world.body(solid, Vector3(0, 0.25, 0), about(Vector3(1, 2, 3).normalized(), 0.5));
    world.set_material(ball, 3, 0);
    world.set_velocity(ball, Vector3(0.5, 0, 0.25));
    world.set_spin(ball, Vector3(1, 2, -2));
    return place_of(ball);
  };
  return scene;
}

// --- joints -----------------------------------------------------------------------------------------------------------

Read pendulum_of(World& world, const std::vector<double>& angles, const std::vector<double>& rates, Chain& chain) {
  chain = hang(world, {0.5, 0.5}, {1, 1});
  start(world, chain, angles, rates);
  return angles_of(chain.joints);
}

Scene double_pendulum(bool flat) {
  Scene scene{flat ? "a double pendulum, flat" : "a double pendulum", 0.5, flat ? Motion::Flat : Motion::Joints};
  scene.build = [](World& world, int) {
    Chain chain;
    return pendulum_of(world, {1.2, 1.8}, {0, 1}, chain);
  };
  return scene;
}

/// The upper arm rotates as its motor says, the lower one swings.
Scene driven_pendulum(bool flat) {
  Scene scene{flat ? "a motor swings a pendulum, flat" : "a motor swings a pendulum", 0.5,
              flat ? Motion::Flat : Motion::Straight};
  // The upper arm rotates by the same angle in each sub-step, which single precision rounds in the same direction.
  if (flat) scene.within = 5e-5;
  scene.build = [](World& world, int) {
    Chain chain;
    Read read = pendulum_of(world, {0, 1}, {2, 0}, chain);
    drive(world, chain.joints[0], 2, 200);
    return read;
  };
  return scene;
}

/// A motor whose strength is used up lifts two arms.
Scene weak_motor(bool flat) {
  Scene scene{flat ? "a weak motor lifts arms, flat" : "a weak motor lifts arms", 0.5,
              flat ? Motion::Flat : Motion::Straight};
  scene.build = [](World& world, int) {
    Chain chain;
    Read read = pendulum_of(world, {0, 0.5}, {0, 0}, chain);
    drive(world, chain.joints[0], 100, 5);
    return read;
  };
  return scene;
}

/// Both arms fall as one, because the elbow presses on its limit.
Scene pressed_limit() {
  Scene scene{"arms fall with an elbow on its limit", 0.4, Motion::Straight};
  scene.build = [](World& world, int) {
    Chain chain;
    Read read = pendulum_of(world, {1.5, 1.5}, {0, 0}, chain);
    breve_drive drive = world.drive(chain.joints[1]);
    drive.low[0] = 0, drive.high[0] = INFINITY;
    drive.force[0] = -2;
    world.set_drive(chain.joints[1], drive);
    return read;
  };
  return scene;
}

Scene heavy_top() {
  Scene scene{"a top on a ball joint", 0.5, Motion::Joints};
  scene.build = [](World& world, int) {
    const breve_object body =
        world.body(lump(1, Vector3(0.02, 0.01, 0.02).asDiagonal()), Vector3::Zero(), about(Vector3::UnitX(), 0.4));
    Hinge hinge;
    hinge.child = body;
    hinge.kind = BREVE_JOINT_BALL;
    hinge.child_point = Vector3(0, -0.2, 0);
    hinge.rotation = about(Vector3::UnitX(), 0.4);
    const breve_object joint = world.join(hinge);
    breve_drive free = world.drive(joint);
    std::fill(free.low, free.low + 3, -INFINITY), std::fill(free.high, free.high + 3, INFINITY);
    world.set_drive(joint, free);
    world.set_spin(body, about(Vector3::UnitX(), 0.4) * Vector3(0, 30, 0));
    return place_of(body);
  };
  return scene;
}

Scene tumbling() {
  Scene scene{"a free body tumbles", 0.5, Motion::Rotation};
  scene.build = [](World& world, int) {
    const breve_object body = world.body(lump(1, Vector3(0.4, 0.5, 0.6).asDiagonal()), Vector3::Zero());
    world.set_spin(body, Vector3(4, 1, -3));
    return [body](const World& seen) {
      const Quaternion o = seen.orientation(body);
      const double sign = o.w() < 0 ? -1 : 1;
      return std::vector<double>{sign * o.w(), sign * o.x(), sign * o.y(), sign * o.z()};
    };
  };
  return scene;
}

Scene damped_slider(bool flat) {
  constexpr double kStiffness = 40, kDamping = 2, kStart = 0.2;
  Scene scene{flat ? "a slider on a spring, flat" : "a slider on a spring", 0.5, flat ? Motion::Flat : Motion::Joints};
  scene.build = [](World& world, int) {
    world.set_gravity(Vector3::Zero());
    Hinge hinge;
    hinge.kind = BREVE_JOINT_PRISMATIC;
    hinge.normal = -Vector3::UnitX();
    hinge.child = world.body(box(Vector3(0.1, 0.1, 0.1), 1), Vector3::Zero());
    const breve_object joint = world.join(hinge);
    breve_drive drive = world.drive(joint);
    drive.stiffness = kStiffness, drive.damping = kDamping;
    drive.low[0] = -INFINITY, drive.high[0] = INFINITY;
    world.set_drive(joint, drive);
    world.set_joint(joint, kStart, 0);
    return angles_of({joint});
  };
  scene.exact = [](double t, int) {
    const double decay = 0.5 * kDamping, rate = std::sqrt(kStiffness - decay * decay);
    return std::vector<double>{kStart * std::exp(-decay * t) *
                               (std::cos(rate * t) + decay / rate * std::sin(rate * t))};
  };
  return scene;
}

// --- closed loops -----------------------------------------------------------------------------------------------------

/// A crank of 0.4 m, a coupler of 1 m and a rocker of 0.8 m on pivots that are 1 m apart, released at rest.
breve_object crank_rocker(World& world) {
  constexpr double kCrank = 0.4, kCoupler = 1, kRocker = 0.8;
  const Vector3 pivot = Vector3::Zero(), far = Vector3::UnitX(), tip = kCrank * Vector3(std::cos(1), std::sin(1), 0);
  const double way = (far - tip).norm(), on = (kCoupler * kCoupler - kRocker * kRocker + way * way) / (2 * way);
  const Vector3 u = (far - tip) / way, side(-u.y(), u.x(), 0);
  const Vector3 knee = tip + on * u + std::sqrt(kCoupler * kCoupler - on * on) * side;
  const Bar first(world, pivot, tip, 1), second(world, tip, knee, 1), third(world, far, knee, 1);
  const breve_object crank = world.join(pin(nullptr, pivot, first, first.begin()));
  world.join(pin(nullptr, far, third, third.begin()));
  world.join(pin(&first, first.end(), second, second.begin()));
  world.join(pin(&second, second.end(), third, third.end()));
  return crank;
}

Scene four_bar(const char* name, double strength, Motion motion) {
  Scene scene{name, 0.5, motion};
  scene.build = [strength](World& world, int) {
    const breve_object crank = crank_rocker(world);
    if (strength > 0) drive(world, crank, 100, strength);
    return angles_of({crank});
  };
  return scene;
}

// --- motors that push through contacts --------------------------------------------------------------------------------

constexpr double kWheel = 0.25, kChassis = 5, kTyre = 0.5;

std::vector<breve_object> add_wheels(World& world, breve_object chassis) {
  std::vector<breve_object> joints;
  for (const double x : {-0.6, 0.6})
    for (const double z : {-0.4, 0.4}) {
      Hinge hinge;
      hinge.parent = chassis;
      hinge.child = world.body(sphere(kWheel, kTyre), Vector3::Zero());
      hinge.parent_point = Vector3(x, -0.2, z);
      hinge.normal = Vector3::UnitZ();
      world.set_material(hinge.child, 1, 0);
      joints.push_back(world.join(hinge));
    }
  return joints;
}

/// @param speed  of the motors, rad/s: beyond what their strength reaches, or such that they reach it
Scene vehicle(const char* name, double speed) {
  constexpr double kStrength = 0.8;
  Scene scene{name, 0.5, Motion::Straight};
  scene.variants = speed < 50 ? 8 : 1;
  const auto vary = [speed](int i) { return speed * (1 + 0.019 * i); };
  scene.build = [vary](World& world, int i) {
    floor_of(world, 0, 1);
    const Vector3 at(0, kWheel + 0.2, 0);
    const breve_object chassis = world.body(box(Vector3(1.5, 0.2, 0.5), kChassis), at);
    for (const breve_object joint : add_wheels(world, chassis)) drive(world, joint, vary(i), kStrength);
    return [chassis](const World& seen) { return std::vector<double>{std::abs(seen.at(chassis).x())}; };
  };
  scene.exact = [vary](double t, int i) {
    const double pull = 4 * kStrength / kWheel / (kChassis + 4 * kTyre * (1 + 2.0 / 5));
    const double reached = std::min(t, vary(i) * kWheel / pull);
    return std::vector<double>{0.5 * pull * reached * reached + vary(i) * kWheel * (t - reached)};
  };
  return scene;
}

/// A weak motor in the shoulder drags the tip of a bent arm over a floor.
Scene dragging_arm() {
  Scene scene{"an arm drags its tip over a floor", 0.3, Motion::Curved};
  scene.build = [](World& world, int) {
    constexpr double kArm = 0.6, kTip = 0.05, kShoulder = 0.8;
    floor_of(world, 0, 0.3);
    const double lean = std::acos((kShoulder - kTip) / (2 * kArm));
    const Vector3 from(0, kShoulder, 0), elbow = from + kArm * Vector3(std::sin(lean), -std::cos(lean), 0);
    const Vector3 tip = elbow + kArm * Vector3(-std::sin(lean), -std::cos(lean), 0);
    const Bar upper(world, from, elbow, 1), lower(world, elbow, tip, 1);
    const breve_object shoulder = world.join(pin(nullptr, from, upper, upper.begin()));
    const breve_object bend = world.join(pin(&upper, upper.end(), lower, lower.begin()));
    Hinge foot;
    foot.parent = lower.body;
    foot.child = world.body(sphere(kTip, 0.2), Vector3::Zero());
    foot.kind = BREVE_JOINT_FIXED;
    foot.parent_point = lower.end();
    world.set_material(foot.child, 0.3, 0);
    world.join(foot);
    drive(world, shoulder, 100, 6);
    return angles_of({shoulder, bend});
  };
  return scene;
}

/// A motor turns a crank that pushes a block over a rough floor: contact between a link and a free body that slide on
/// each other.
Scene paddle() {
  Scene scene{"a paddle pushes a block", 0.3, Motion::Curved};
  scene.build = [](World& world, int) {
    floor_of(world, 0, 0.2);
    const Vector3 from(0, 1, 0), tip(0, 0.1, 0);
    const breve_object arm = world.body(capsule(0.05, 0.9, 1), 0.5 * (from + tip));
    Hinge hinge;
    hinge.child = arm;
    hinge.parent_point = from;
    hinge.child_point = Vector3(0, 0.45, 0);
    hinge.normal = -Vector3::UnitZ();
    const breve_object joint = world.join(hinge);
    drive(world, joint, 1, 200);
    world.set_joint(joint, 0, 1);
    const breve_object block = world.body(box(Vector3(0.4, 0.4, 0.4), 1), Vector3(0.25, 0.2, 0));
    world.set_velocity(block, Vector3(0.8, 0, 0));
    world.set_material(arm, 0.2, 0);
    world.set_material(block, 0.2, 0);
    return place_of(block);
  };
  return scene;
}

}  // namespace

std::vector<Scene> smooth_scenes() {
  return {sliding("a block slides until it stops", {0.3, 0.5, -0.6}, Motion::Straight),
          sliding("a block slides up a slope and back", {0.3, 0.2, 1}, Motion::Curved),
          conveyor(),
          spring_on_floor(),
          ladder(),
          rolling("a ball rolls down a slope", sphere(0.25, 1), 5.0 / 7),
          rolling("a cylinder rolls down a slope", cylinder(0.25, 0.4, 1), 2.0 / 3),
          skidding(),
          ball_over_ball(),
          uneven_ball(),
          double_pendulum(false),
          driven_pendulum(false),
          weak_motor(false),
          pressed_limit(),
          heavy_top(),
          tumbling(),
          damped_slider(false),
          four_bar("a four-bar linkage falls", 0, Motion::Joints),
          four_bar("a weak motor turns a four-bar linkage", 6, Motion::Straight),
          vehicle("a vehicle gathers speed", 1000),
          vehicle("a vehicle reaches its speed", 3),
          dragging_arm(),
          paddle(),
          sliding("a block slides until it stops, flat", {0.3, 0.5, -0.6}, Motion::Flat),
          rolling("a disc rolls down a slope, flat", cylinder(0.25, 0.4, 1), 2.0 / 3, true),
          double_pendulum(true),
          driven_pendulum(true),
          weak_motor(true),
          damped_slider(true),
          four_bar("a four-bar linkage falls, flat", 0, Motion::Flat)};
}

}  // namespace breve::reference
