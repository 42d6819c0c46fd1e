// Flat scenes in Box2D, in single precision, which is what it has.
#include <box2d/box2d.h>

#include <algorithm>
#include <cmath>

#include "tests/bench/dynamics_scenes/peers.hpp"

namespace breve::bench {
namespace {

using namespace scenes;

b2Vec2 convert(const Vector3& v) { return {static_cast<float>(v.x()), static_cast<float>(v.y())}; }
Vector3 convert(const b2Vec2& v) { return {v.x, v.y, 0}; }

struct Filter : b2ContactFilter {
  bool ShouldCollide(b2Fixture* a, b2Fixture* b) override {
    const auto first = a->GetUserData().pointer, second = b->GetUserData().pointer;  // assembly + 1
    return first == 0 || first != second;
  }
};

class Box2D : public Side {
 public:
  Box2D(const Scene& scene, double step)
      : scene_(scene), step_(static_cast<float>(step)), bodies_(scene.bodies.size()) {
    world_.SetGravity(b2Vec2(0, static_cast<float>(-scene.gravity)));
    world_.SetAllowSleeping(false);
    world_.SetContactFilter(&filter_);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      if (scene.bodies[i].born == 0) appear(static_cast<int>(i));
    for (const Joint& joint : scene.joints) add(joint);
  }

  void appear(int number) override {
    const auto i = static_cast<std::size_t>(number);
    if (bodies_[i]) return;
    const Body& one = scene_.bodies[i];
    b2BodyDef def;
    def.type = one.motion == Motion::Free ? b2_dynamicBody : b2_staticBody;
    def.position = convert(one.at);
    def.angle = static_cast<float>(2 * std::atan2(one.orientation.z(), one.orientation.w()));
    def.linearVelocity = convert(one.velocity);
    def.angularVelocity = static_cast<float>(one.spin.z());
    bodies_[i] = world_.CreateBody(&def);
    const Shape& shape = scene_.shapes[one.shape];
    add(*bodies_[i], shape, one.assembly);
    if (one.motion != Motion::Free) return;
    const MassProperties mass = mass_properties(shape);
    const b2MassData data{static_cast<float>(mass.mass), b2Vec2(0, 0), static_cast<float>(mass.inertia.z())};
    bodies_[i]->SetMassData(&data);
  }

  Vector3 at(int body) const override { return convert(of(body).GetPosition()); }
  double angle(int joint) const override { return joints_[static_cast<std::size_t>(joint)]->GetJointAngle(); }
  void set_force(int body, const Vector3& force) override { of(body).ApplyForceToCenter(convert(force), true); }
  void set_velocity(int body, const Vector3& velocity) override { of(body).SetLinearVelocity(convert(velocity)); }
  void set_motor(int joint, double speed) override {
    joints_[static_cast<std::size_t>(joint)]->SetMotorSpeed(static_cast<float>(speed));
  }
  void step() override {
    for (const Spring& spring : scene_.springs) {
      b2Body &a = of(spring.a), &b = of(spring.b);
      const b2Vec2 force = convert(spring_force(spring, convert(b.GetPosition() - a.GetPosition()),
                                                convert(b.GetLinearVelocity() - a.GetLinearVelocity())));
      a.ApplyForceToCenter(force, true);
      b.ApplyForceToCenter(-force, true);
    }
    world_.Step(step_, 8, 3);
  }

 private:
  b2Body& of(int body) const { return *bodies_[static_cast<std::size_t>(body)]; }

  void attach(b2Body& body, const b2Shape& shape, int assembly) {
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.density = 1;
    fixture.friction = static_cast<float>(scene_.friction);
    fixture.restitution = static_cast<float>(scene_.restitution);
    fixture.restitutionThreshold = static_cast<float>(scene_.threshold);
    fixture.userData.pointer = static_cast<std::uintptr_t>(assembly + 1);
    body.CreateFixture(&fixture);
  }

  /// Its cut with the plane z = 0: the scenes in the plane have balls, boxes, prisms about z, and fields.
  void add(b2Body& body, const Shape& shape, int assembly) {
    if (shape.form == Form::Ball) {
      b2CircleShape circle;
      circle.m_radius = static_cast<float>(shape.radius);
      attach(body, circle, assembly);
    } else if (shape.form == Form::Box) {
      b2PolygonShape box;
      box.SetAsBox(static_cast<float>(shape.size.x() / 2), static_cast<float>(shape.size.y() / 2));
      attach(body, box, assembly);
    } else if (shape.form == Form::Field) {
      std::vector<b2Vec2> points;  // from the right, so that outside is above
      for (std::uint32_t i = shape.columns; i-- > 0;)
        points.push_back(convert({shape.tile * (i - 0.5 * (shape.columns - 1)), shape.heights[i], 0}));
      b2ChainShape chain;
      chain.CreateChain(points.data(), static_cast<int>(points.size()), points.front() + b2Vec2(1, 0),
                        points.back() - b2Vec2(1, 0));
      attach(body, chain, assembly);
    } else {
      add_polygon(body, shape, assembly);
    }
  }

  /// A fan of pieces that have as many corners as Box2D takes.
  void add_polygon(b2Body& body, const Shape& shape, int assembly) {
    std::vector<b2Vec2> corners;
    for (const Vector3& corner : shape.corners)
      if (corner.z() > 0) corners.push_back(convert(corner));
    for (std::size_t i = 1; i + 1 < corners.size(); i += b2_maxPolygonVertices - 2) {
      std::vector<b2Vec2> piece{corners[0]};
      for (std::size_t k = i; k < std::min(i + b2_maxPolygonVertices - 1, corners.size()); ++k)
        piece.push_back(corners[k]);
      b2PolygonShape polygon;
      polygon.Set(piece.data(), static_cast<int>(piece.size()));
      attach(body, polygon, assembly);
    }
  }

  void add(const Joint& joint) {
    b2RevoluteJointDef def;
    def.Initialize(&of(joint.parent), &of(joint.child), convert(joint.at));
    def.enableLimit = std::isfinite(joint.low[0]);
    if (def.enableLimit) {
      def.lowerAngle = static_cast<float>(joint.low[0]);
      def.upperAngle = static_cast<float>(joint.high[0]);
    }
    def.enableMotor = joint.strength > 0;
    def.maxMotorTorque = static_cast<float>(joint.strength);
    joints_.push_back(static_cast<b2RevoluteJoint*>(world_.CreateJoint(&def)));
  }

  const Scene& scene_;
  float step_;
  Filter filter_;
  b2World world_{b2Vec2(0, 0)};
  std::vector<b2Body*> bodies_;
  std::vector<b2RevoluteJoint*> joints_;
};

}  // namespace

std::unique_ptr<Side> make_box2d(const Scene& scene, double step) { return std::make_unique<Box2D>(scene, step); }

}  // namespace breve::bench
