// Free bodies and walls that stay in place: they rest, bounce, slide and stay inside.
#include "core/body_walls.h"

#include <gtest/gtest.h>

#include "core/boundary/mass_properties.h"
#include "tests/contact_shapes.h"
#include "tests/particle_sets.h"

namespace molten::body_walls_test {
namespace {

using namespace contact_test;

constexpr double radius = 0.05, dt = 1e-3, g = 9.81;

template <int Dim> Wall<Dim> cube(double half);
template <> Wall<2> cube(double half) { return square(half, false); }
template <> Wall<3> cube(double half) { return box(half, false); }
template <int Dim> Wall<Dim> tank(double half, Response response);
template <> Wall<2> tank(double half, Response response) { return square(half, true, response); }
template <> Wall<3> tank(double half, Response response) { return box(half, true, response); }

/// A block of 1 kg/m³ among fixed walls, without particles.
template <int Dim> struct Fall {
  Bodies<Dim> bodies;
  Contact<Dim> contact;
  std::vector<Point<Dim>> corners;
  std::array<double, Dim> gravity{};
  double time = 0;

  Fall(std::vector<Wall<Dim>> walls, double half, const Point<Dim>& centre, const Point<Dim>& velocity,
       const Spin<Dim>& spin, SearchMethod method = SearchMethod::by_rule)
      : bodies({body_of(half, centre, velocity, spin)}), contact(with_block(walls, half), radius, 5 * radius, method) {
    corners = corners_of(contact, 0);
    gravity[Dim - 1] = -g;
  }
  static RigidBody<Dim> body_of(double half, const Point<Dim>& centre, const Point<Dim>& velocity,
                                const Spin<Dim>& spin) {
    const MassProperties<Dim> mass = mass_properties(cube<Dim>(half));
    RigidBody<Dim> body;
    body.centre = centre;
    body.extent = half * std::sqrt(Dim);
    body.inertia = Inertia<Dim>{mass.measure, mass.inertia};
    body.prescribed.velocity = velocity;
    body.prescribed.spin = spin;
    return body;
  }
  static std::vector<Wall<Dim>> with_block(std::vector<Wall<Dim>> walls, double half) {
    walls.push_back(cube<Dim>(half));
    walls.back().body = 0;
    return walls;
  }

  void step() {
    bodies.begin_step(contact, time, dt, gravity);
    bodies.end_step(std::vector<Kick<Dim>>(1), 1);
    time += dt;
  }
  void run(double end) {
    while (time < end) step();
  }
  const RigidMotion<Dim>& motion() const { return bodies.motion(0); }
  /// The smallest of what f(corner) is, m.
  template <class F> double least(F&& f) const {
    double least = HUGE_VAL;
    for (const auto& c : corners) least = std::min(least, f(motion().start.to_world(c)));
    return least;
  }
  double energy() const {
    const auto& inertia = *bodies.body(0).inertia;
    return inertia.mass * (motion().velocity.squaredNorm() / 2 + g * motion().start.centre[Dim - 1]) +
           motion().spin.dot(bodies.angular_momentum(0)) / 2;
  }
};

template <int Dim> Wall<Dim> floor_with(Response response) {
  return plane<Dim>(Point<Dim>::Zero(), Point<Dim>::Unit(Dim - 1), response);
}

template <int Dim> void expect_rest() {
  Fall<Dim> fall({floor_with<Dim>({})}, 0.1, 0.5 * Point<Dim>::Unit(Dim - 1), Point<Dim>::Unit(0), Spin<Dim>::Zero());
  fall.run(2);
  EXPECT_NEAR(fall.motion().start.centre[Dim - 1], 0.1, 1e-5);
  const double at = fall.motion().start.centre[0];
  fall.run(3);
  EXPECT_NEAR(fall.motion().start.centre[0], at, 1e-9);
  EXPECT_LT(fall.motion().velocity.norm() + fall.motion().spin.norm(), 1e-9);
  EXPECT_GE(fall.least([](const Point<Dim>& x) { return x[Dim - 1]; }), 0);
}

TEST(BodyWalls, ABlockComesToRestOnAFloor) {
  expect_rest<2>();
  expect_rest<3>();
}

TEST(BodyWalls, BouncesByItsRestitution) {
  Fall<3> fall({floor_with<3>({0.5, 1})}, 0.1, {0, 0, 0.6}, {0, 0, 0}, {0, 0, 0});
  double highest = 0;
  for (bool rising = false; fall.time < 0.9; fall.step()) {
    rising = rising || fall.motion().velocity.z() > 0;
    if (rising) highest = std::max(highest, fall.motion().start.centre.z());
  }
  EXPECT_NEAR(highest - 0.1, 0.25 * 0.5, 0.003) << "of 0.5 m";
}

TEST(BodyWalls, SlidesDownASlopeAgainstFriction) {
  const double tilt = 20 * M_PI / 180;
  for (const double friction : {0.2, 0.5}) {
    const Response rough{0, 0, Response::Grip{friction, 0}};
    Fall<2> fall({floor_with<2>(rough)}, 0.1, {0, 0.1 + 1e-6}, {0, 0}, Spin<2>::Zero());
    fall.gravity = {g * std::sin(tilt), -g * std::cos(tilt)};
    fall.run(1);
    const double wanted = std::max(0.0, g * (std::sin(tilt) - friction * std::cos(tilt)));
    EXPECT_NEAR(fall.motion().velocity.x(), wanted, 0.02 + 0.01 * wanted) << friction;
    EXPECT_NEAR(fall.motion().spin[0], 0, 0.05);
  }
}

/// Thrown about, a block stays in its tank and gains no energy.
template <int Dim> void expect_held(SearchMethod method) {
  Random<3> random(7);
  for (int k = 0; k < 20; ++k) {
    Point<Dim> v;
    Spin<Dim> spin;
    for (int d = 0; d < Dim; ++d) v[d] = 10 * random.uniform();
    for (auto& w : spin.reshaped()) w = 20 * random.uniform();
    Fall<Dim> fall({tank<Dim>(1, {0.5 * (k % 2), k % 3 / 2.0})}, 0.2, Point<Dim>::Zero(), v, spin, method);
    double energy = fall.energy();
    while (fall.time < 2) {
      fall.step();
      ASSERT_LE(fall.energy(), energy + 0.002 * (1 + std::abs(energy))) << k << " at " << fall.time;
      energy = std::min(energy, fall.energy());
      ASSERT_GT(fall.least([](const Point<Dim>& x) { return 1 - x.cwiseAbs().maxCoeff(); }), -2e-3) << k;
    }
    EXPECT_LT(fall.motion().start.centre[Dim - 1], -0.6);
  }
}

TEST(BodyWalls, StayInATank) {
  for (const SearchMethod method : {SearchMethod::grid, SearchMethod::tree}) {
    expect_held<2>(method);
    expect_held<3>(method);
  }
}

}  // namespace
}  // namespace molten::body_walls_test
