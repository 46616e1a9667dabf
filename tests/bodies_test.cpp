// Walls that move: mass and inertia, prescribed ways, contact with particles, and what free bodies give and receive.
#include "core/bodies.h"

#include <gtest/gtest.h>

#include "core/boundary/mass_properties.h"
#include "tests/contact_shapes.h"
#include "tests/flavours.h"
#include "tests/particle_sets.h"

namespace molten::bodies_test {
namespace {

using namespace contact_test;

constexpr double radius = 0.05, skin = 1e-8 * radius;

template <int Dim> Wall<Dim> as_body(Wall<Dim> wall, std::int32_t body = 0) {
  wall.body = body;
  return wall;
}

Wall<2> block(Random<2>&, double half) { return square(half, false); }
Wall<3> block(Random<3>&, double half) { return box(half, false); }

template <int Dim> Spin<Dim> random_spin(Random<3>& random, double size) {
  return size * Spin<Dim>::NullaryExpr([&](Eigen::Index) { return random.uniform(); });
}

// --- Mass -----------------------------------------------------------------------------------------------------------

TEST(MassProperties, OfABoxAnywhere) {
  Wall<3> wall = box(1, false);
  for (auto& v : wall.vertices) v = v.cwiseProduct(Point<3>(0.5, 1, 2)) + Point<3>(100, -20, 3);
  const MassProperties<3> p = mass_properties(wall);
  EXPECT_NEAR(p.measure, 8, 1e-12);
  EXPECT_NEAR((p.centre - Point<3>(100, -20, 3)).norm(), 0, 1e-11);
  const Eigen::Vector3d wanted = 8.0 / 12 * Eigen::Vector3d(4 + 16, 1 + 16, 1 + 4);
  EXPECT_NEAR((p.inertia - Eigen::Matrix3d(wanted.asDiagonal())).norm(), 0, 1e-10);
}

TEST(MassProperties, OfARectangleAndOfNothing) {
  Wall<2> wall = square(1, false);
  for (auto& v : wall.vertices) v = v.cwiseProduct(Point<2>(0.5, 1)) + Point<2>(7, 8);
  const MassProperties<2> p = mass_properties(wall);
  EXPECT_NEAR(p.measure, 2, 1e-13);
  EXPECT_NEAR((p.centre - Point<2>(7, 8)).norm(), 0, 1e-12);
  EXPECT_NEAR(p.inertia(0, 0), 2.0 / 12 * (1 + 4), 1e-12);
  EXPECT_LE(mass_properties(box(1, true)).measure, 0) << "inside out";
  EXPECT_EQ(mass_properties(Wall<3>{}).measure, 0);
}

// --- Ways -----------------------------------------------------------------------------------------------------------

TEST(PrescribedMotion, FollowsItsKeyFrames) {
  PrescribedMotion<3> m;
  m.key_frames = {{1, {0, 0, 0}, {0, 0, 0}}, {2, {2, 0, -1}, {0, 0, M_PI / 2}}, {4, {2, 0, 0}, {0, 0, M_PI / 2}}};
  const Point<3> c(5, 5, 5);
  EXPECT_EQ(m.at(c, 0).centre, c);
  EXPECT_NEAR((m.at(c, 1.5).centre - Point<3>(6, 5, 4.5)).norm(), 0, 1e-14);
  EXPECT_NEAR((m.at(c, 2).to_world({1, 0, 0}) - Point<3>(7, 6, 4)).norm(), 0, 1e-14);
  EXPECT_NEAR((m.at(c, 3).centre - Point<3>(7, 5, 4.5)).norm(), 0, 1e-14);
  EXPECT_NEAR((m.at(c, 9).centre - Point<3>(7, 5, 5)).norm(), 0, 1e-14);
}

TEST(Bodies, AFreeBodyFallsAndKeepsItsAngularMomentum) {
  RigidBody<3> body;
  body.inertia = Inertia<3>{2, Eigen::Vector3d(1, 2, 4).asDiagonal()};
  body.prescribed.spin = {0.1, 3, 0.2};
  Bodies<3> bodies({body});
  Contact<3> contact({as_body(box(0.5, false))}, radius, 5 * radius);
  const Spin<3> before = bodies.angular_momentum(0);
  const std::vector<Kick<3>> none(1);
  const double dt = 1e-4;
  for (int step = 0; step < 10000; ++step) {
    bodies.begin_step(contact, step * dt, dt, {0, 0, -9.81});
    bodies.end_step(none, 1);
  }
  EXPECT_NEAR(bodies.motion(0).start.centre.z(), -9.81 / 2, 1e-3);
  EXPECT_EQ(bodies.angular_momentum(0), before);
  const auto& turn = bodies.motion(0).start.turn;
  EXPECT_NEAR((turn * turn.transpose() - Turn<3>::Identity()).norm(), 0, 1e-13);
  const Spin<3> own = turn.transpose() * before;  // free of torque, the energy stays, too
  EXPECT_NEAR(own.dot(Eigen::Vector3d(1, 0.5, 0.25).cwiseProduct(own)), 0.01 + 18 + 0.16, 0.02);
}

// --- Contact --------------------------------------------------------------------------------------------------------

TEST(MovingContact, APlateTakesParticlesAlongAtAnySpeed) {
  const auto plate = as_body(terrain(4, [](int, int) { return 0.0; }, {0, 0}));  // front side up
  for (const double speed : {0.1, 10.0, 1000.0, 100000.0}) {
    Contact<3> contact({plate}, radius, 5 * radius);
    contact.set_motion(0, {{}, {0, 0, speed}, {0, 0, 0}});
    Motion<3> m{{2.3, 1.7, radius + 0.5 * speed * 0.01}, {0, 0, 0}, {0, 0, 0}};
    EXPECT_EQ(contact.move(m, 0.01), 1) << speed;
    EXPECT_NEAR(m.position.z() - speed * 0.01, radius, 3 * skin + 1e-15 * speed);
    EXPECT_NEAR(m.velocity.z(), speed, 1e-9 * speed);
  }
}

TEST(MovingContact, ABeltDragsByFriction) {
  Contact<3> contact({as_body(plane<3>({0, 0, 0}, {0, 0, 1}, {0, 0, Response::Grip{0.3, 0}}))}, radius, 5 * radius);
  contact.set_motion(0, {{}, {2, 0, 0}, {0, 0, 0}});
  Motion<3> m{{0, 0, radius + skin}, {0, 0, 0}, {0, 0, 0}};
  const double dt = 1e-3;
  for (int step = 1; step <= 1000; ++step) {
    m.velocity.z() -= 9.81 * dt;
    m.rate = m.velocity;
    contact.set_motion(0, {{{2 * (step - 1) * dt, 0, 0}, Turn<3>::Identity()}, {2, 0, 0}, {0, 0, 0}});
    contact.move(m, dt);
    ASSERT_NEAR(m.velocity.x(), std::min(2.0, 0.3 * 9.81 * step * dt), 1e-6);
  }
}

/// A block that flies and turns through a cloud of particles; none may ever be in it.
template <int Dim> void nothing_enters_a_tumbling_block(double speed) {
  Random<Dim> random(4);
  Random<3> spins(5);
  Contact<Dim> contact({as_body(block(random, 0.4))}, radius, 5 * radius);
  std::vector<Motion<Dim>> cloud;
  for (int k = 0; k < 600; ++k) {
    const Point<Dim> x = 1.2 * random.point();
    if (x.norm() > 0.4 * std::sqrt(Dim) + radius) cloud.push_back({x, random.point(), Point<Dim>::Zero()});
  }
  RigidMotion<Dim> motion;
  const double dt = 0.01;
  int bounces = 0;
  for (int step = 0; step < 300; ++step) {
    motion.velocity = speed * random.unit() - 0.5 * speed * motion.start.centre;
    motion.spin = random_spin<Dim>(spins, 0.5 * speed);
    contact.set_motion(0, motion);
    for (auto& m : cloud) {
      m.rate = m.velocity;
      bounces += contact.move(m, dt);
    }
    motion = {motion.after(dt), Point<Dim>::Zero(), Spin<Dim>::Zero()};
    contact.set_motion(0, motion);
    for (const auto& m : cloud)
      ASSERT_GT(contact.signed_distance(m.position, 1), radius * (1 - 1e-6)) << step << ": " << m.position.transpose();
  }
  EXPECT_GT(bounces, 30);
}

TEST(MovingContact, NothingEntersATumblingBlock) {
  for (const double speed : {1.0, 10.0, 50.0}) {
    nothing_enters_a_tumbling_block<2>(speed);
    nothing_enters_a_tumbling_block<3>(speed);
  }
}

TEST(MovingContact, ParticlesBetweenAPressAndTheFloorStayBetween) {
  Random<3> random(8);
  const auto floor = terrain(4, [](int, int) { return 0.0; }, {0, 1});
  auto press = as_body(terrain(4, [](int, int) { return 0.0; }, {0, 1}));
  for (auto& f : press.facets) std::swap(f[1], f[2]);  // front side down
  std::vector<Wall<3>> walls = {floor, press};  // and walls around, so that none leaves and comes back above the press
  for (int axis = 0; axis < 2; ++axis)
    for (const double end : {0.0, 4.0})
      walls.push_back(plane<3>(end * Point<3>::Unit(axis), (end > 0 ? -1 : 1) * Point<3>::Unit(axis), {0, 1}));
  Contact<3> contact(walls, radius, 5 * radius);
  std::vector<Motion<3>> all;
  for (int k = 0; k < 200; ++k)
    all.push_back(
        {{random.uniform(1, 3), random.uniform(1, 3), random.uniform(0.06, 0.9)}, Point<3>::Zero(), Point<3>::Zero()});
  const double dt = 0.01;
  for (int step = 0; step < 85; ++step) {
    const double height = 1 - step * 0.01;
    contact.set_motion(0, {{{0, 0, height}, Turn<3>::Identity()}, {0, 0, -1}, {0, 0, 0}});
    for (auto& m : all) {
      m.velocity = m.rate = m.velocity + 5 * random.point();
      contact.move(m, dt);
      ASSERT_GT(m.position.z(), radius * (1 - 1e-6));
      ASSERT_LT(m.position.z(), height - 0.01 - radius * (1 - 1e-6));
    }
  }
}

// --- Momentum -------------------------------------------------------------------------------------------------------

template <int Dim> struct Momentum {
  Point<Dim> linear = Point<Dim>::Zero();
  Spin<Dim> angular = Spin<Dim>::Zero();

  void add(double mass, const Point<Dim>& x, const Point<Dim>& v) {
    linear += mass * v;
    angular += mass * moment_of(x, v);
  }
};

template <int Dim> Momentum<Dim> momentum_of(const Bodies<Dim>& bodies) {
  Momentum<Dim> m;
  for (std::size_t k = 0; k < bodies.count(); ++k) {
    m.add(bodies.body(k).inertia->mass, bodies.motion(k).start.centre, bodies.motion(k).velocity);
    m.angular += bodies.angular_momentum(k);
  }
  return m;
}

template <int Dim> RigidBody<Dim> free_block(const Wall<Dim>& wall, double density) {
  const MassProperties<Dim> p = mass_properties(wall);
  RigidBody<Dim> body;
  body.centre = p.centre;
  body.extent = 1;
  body.inertia = Inertia<Dim>{density * p.measure, density * p.inertia};
  return body;
}

template <int Dim> void hail_conserves_momentum() {
  Random<Dim> random(6);
  Wall<Dim> wall = as_body(block(random, 0.4));
  wall.response = {0.4, 0, Response::Grip{0.3, 0}};
  RigidBody<Dim> body = free_block(wall, 100);
  body.prescribed.velocity = random.point();
  Bodies<Dim> bodies({body});
  Contact<Dim> contact({wall}, radius, 5 * radius);
  std::vector<Motion<Dim>> hail;
  for (int k = 0; k < 200; ++k) {
    const Point<Dim> x = (1.0 + 2 * random.uniform(0, 1)) * random.unit();
    const Point<Dim> v = -random.uniform(0.5, 3) * x + random.point();
    hail.push_back({x, v, v});
  }
  const double mass = 0.2;
  const auto all = [&] {
    Momentum<Dim> m = momentum_of(bodies);
    for (const auto& h : hail) m.add(mass, h.position, h.velocity);
    return m;
  };
  const Momentum<Dim> before = all();
  double traffic = 0;
  for (int step = 0; step < 100; ++step) {
    std::vector<Kick<Dim>> kicks(1);
    bodies.begin_step(contact, 0.01 * step, 0.01, {});
    for (auto& h : hail) contact.move(h, 0.01, kicks);
    traffic += mass * kicks[0].linear.norm();
    for (auto& h : hail) h.rate = h.velocity;
    bodies.end_step(kicks, mass);
  }
  EXPECT_GT(traffic, 10);
  EXPECT_NEAR((all().linear - before.linear).norm(), 0, 1e-9 * traffic);
  EXPECT_NEAR((all().angular - before.angular).norm(), 0, 1e-9 * traffic);
}

TEST(FreeBody, HailConservesLinearAndAngularMomentum) {
  hail_conserves_momentum<2>();
  hail_conserves_momentum<3>();
}

template <class F> class FreeBodyInFluid : public ::testing::Test {};
TYPED_TEST_SUITE(FreeBodyInFluid, Flavours, FlavourNames);

/// The velocity that carries the momentum: the leap-frog's.
template <int Dim, class Real> Momentum<Dim> momentum_of(const State<Dim, Real>& s) {
  Momentum<Dim> m = momentum_of(s.bodies);
  const double mass = s.parameters.particle_mass;
  particle_sets::for_each_particle(s.particles, [&](std::size_t k, const auto& at) {
    Point<Dim> x, v;
    for (int d = 0; d < Dim; ++d) x[d] = at[d], v[d] = s.particles[half_velocity][d][k];
    m.add(mass, x, v);
  });
  return m;
}

TYPED_TEST(FreeBodyInFluid, ImpactConservesMomentumToAMillionth) {
  constexpr int dim = TypeParam::dim;
  using Real = typename TypeParam::Real;
  Scene scene = particle_sets::plain_scene(dim);
  scene.numerics.artificial_viscosity = 0.1;
  const double spacing = 0.05;
  Random<dim> random(1);
  Wall<dim> wall = as_body(block(random, 0.15));
  wall.response = {0.2, 0, Response::Grip{0.5, 0}};
  RigidBody<dim> body = free_block(wall, 4000);
  body.centre = Point<dim>::Constant(0.3);
  body.centre[dim - 1] = 0.6 + 0.15 + 0.03;
  body.prescribed.velocity[dim - 1] = -1;
  body.prescribed.spin[0] = 2;
  Features features = features_of(scene);
  features.contact = features.bodies = true;
  const Start start = particle_sets::start_of(scene, particle_sets::cube<dim>(12, spacing), spacing);
  auto s = make_state<dim, Real>(features, parameters_of<dim>(scene, start),
                                 {Contact<dim>({wall}, spacing / 2, 2.6 * spacing), Bodies<dim>({body})}, start);
  const Momentum<dim> before = momentum_of(s);
  for (int k = 0; k < 300; ++k) step(s);
  const Momentum<dim> after = momentum_of(s);
  const double given = body.inertia->mass * (s.bodies.motion(0).velocity - body.prescribed.velocity).norm();
  EXPECT_GT(given, 0.01 * before.linear.norm()) << "or it hit nothing";
  EXPECT_LT((after.linear - before.linear).norm(), 1e-6 * before.linear.norm());
  EXPECT_LT((after.angular - before.angular).norm(), 1e-6 * before.angular.norm());
}

}  // namespace
}  // namespace molten::bodies_test
