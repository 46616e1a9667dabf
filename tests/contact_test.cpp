#include "core/boundary/contact.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/contact_shapes.h"

namespace molten::contact_test {
namespace {

using namespace contact_test;

constexpr double radius = 0.05, skin = 1e-8 * radius;

template <int Dim> Contact<Dim> contact_with(std::vector<Wall<Dim>> walls, double r = radius) {
  return Contact<Dim>(std::move(walls), r, 5 * r);
}

template <int Dim> Motion<Dim> motion(const Point<Dim>& x, const Point<Dim>& v) { return {x, v, v}; }

const std::vector<Response> responses = {{0, 0}, {0, 1}, {1, 1}, {0.5, 0.5}, {1, 0}, {0.9, 1}, {0, 0.7}};

// --- One wall -------------------------------------------------------------------------------------------------------

TEST(Contact, ReflectsVelocityAndRate) {
  const auto contact = contact_with<2>({plane<2>({0, 0}, {0, 1}, {0.5, 0.8})});
  Motion<2> m{{0, 1 + radius}, {3, -4}, {1, -2}};
  EXPECT_EQ(contact.move(m, 1.0), 1);  // touches after 0.5 s
  EXPECT_NEAR((m.velocity - Point<2>(2.4, 2)).norm(), 0, 1e-12);
  EXPECT_NEAR((m.rate - Point<2>(0.8, 1)).norm(), 0, 1e-12);
  EXPECT_NEAR((m.position - Point<2>(0.5 + 0.4, radius + 0.5)).norm(), 0, 2 * skin);
}

TEST(Contact, TheVelocityMayAlreadyLeave) {
  const auto contact = contact_with<2>({plane<2>({0, 0}, {0, 1}, {0.5, 1})});
  Motion<2> m{{0, radius + 0.1}, {1, 2}, {1, -2}};  // XSPH: moved against its own velocity
  contact.move(m, 0.1);
  EXPECT_NEAR((m.velocity - Point<2>(1, 2)).norm(), 0, 1e-12);
  EXPECT_NEAR((m.rate - Point<2>(1, 1)).norm(), 0, 1e-12);
}

TEST(Contact, NoSlipStops) {
  const auto contact = contact_with<3>({box(1, true, {0, 0})});
  auto m = motion<3>({0, 0, 0}, {3, 1, 2});
  EXPECT_EQ(contact.move(m, 10), 1);
  EXPECT_EQ(m.velocity, Point<3>(0, 0, 0));
  EXPECT_NEAR(m.position.x(), 1 - radius, 2 * skin);
  EXPECT_NEAR(m.position.y(), (1 - radius) / 3, 2 * skin);
}

TEST(Contact, SlidesForTheRestOfTheStep) {
  const auto contact = contact_with<3>({plane<3>({0, 0, 0}, {0, 0, 1}, {0, 1})});
  auto m = motion<3>({0, 0, 1 + radius}, {3, 1, -2});
  contact.move(m, 1);
  EXPECT_NEAR((m.position - Point<3>(3, 1, radius)).norm(), 0, 2 * skin);
}

TEST(Contact, BouncesSeveralTimesAStep) {
  // [P] moves on freely after the first bounce: here that would leave the tank through the opposite wall.
  const auto contact = contact_with<2>({square(1, true, {1, 1})});
  auto m = motion<2>({0, 0}, {4, 0});
  EXPECT_EQ(contact.move(m, 1), 2);  // 0.95 there, 1.9 back, 1.15 on
  EXPECT_NEAR(m.position.x(), -0.95 + 1.15, 5 * skin);
  EXPECT_NEAR(m.velocity.x(), 4, 1e-12);
  auto endless = motion<2>({0, 0}, {1e6, 0});
  EXPECT_EQ(contact.move(endless, 1), 8);  // and then stays at the last contact
  EXPECT_LE(std::abs(endless.position.x()), 1 - radius + skin);
}

TEST(Contact, OverlapAtTheStartIsPushedOut) {
  const auto contact = contact_with<3>({terrain(4, [](int, int) { return 0.0; }, {0, 1})});
  for (const double height : {0.9 * radius, 0.0, -0.5 * radius, -0.99 * radius}) {
    auto m = motion<3>({1.3, 1.7, height}, {0.2, 0, -1});
    contact.move(m, 0.1);
    EXPECT_NEAR((m.position - Point<3>(1.32, 1.7, radius)).norm(), 0, 2 * skin) << height;
    auto at_rest = motion<3>({2, 2, height}, {0, 0, 0});  // at a vertex of the floor
    contact.move(at_rest, 0.1);
    EXPECT_NEAR((at_rest.position - Point<3>(2, 2, radius)).norm(), 0, 2 * skin) << height;
  }
  auto deep = motion<3>({1.3, 1.7, -1.1 * radius}, {0, 0, -1});
  contact.move(deep, 0.1);
  EXPECT_NEAR(deep.position.z(), -1.1 * radius - 0.1, 1e-12) << "behind by more than a radius: not held";
}

TEST(Contact, BehindAThinPlateTheNearerFrontCounts) {
  // Two opposite triangles 0.2 radii apart: overlapping the upper one means being within a radius behind the lower one.
  const double t = 0.2 * radius;
  auto upper = triangle({-1, -1, t}, {1, -1, t}, {0, 1, t}), lower = triangle({-1, -1, 0}, {0, 1, 0}, {1, -1, 0});
  const auto contact = contact_with<3>({lower, upper});
  for (const double height : {t + 0.5 * radius, t, t - 0.01 * radius}) {
    auto m = motion<3>({0, 0, height}, {0, 0, 0});
    contact.move(m, 0.1);
    EXPECT_NEAR(m.position.z(), t + radius, 3 * skin);
  }
  // Both sides at the very same place.
  const auto sheet =
      contact_with<3>({triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}), triangle({-1, -1, 0}, {0, 1, 0}, {1, -1, 0})});
  for (const double side : {-1.0, 1.0}) {
    auto m = motion<3>({0, 0, side * 0.5 * radius}, {0, 0, -side});
    sheet.move(m, 0.1);
    EXPECT_NEAR(m.position.z(), side * radius, 3 * skin);
  }
}

TEST(Contact, OneSided) {
  const auto contact = contact_with<3>({triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {1, 1})});
  auto m = motion<3>({0, 0, -1}, {0.1, 0, 2});
  EXPECT_EQ(contact.move(m, 1), 0);
  EXPECT_NEAR(m.position.z(), 1, 1e-12);
}

TEST(Contact, ASharpValleyIsPassedFromBehind) {
  // Left of the tip the path is behind one side of the valley and "in front" of the other's line: the tip decides.
  const auto contact = contact_with<2>({chain({{-0.5, 2}, {0, 0}, {0.5, 2}}, false, {1, 1})});
  const Point<2> d(-1.2, 0.6);
  auto m = motion<2>(Point<2>(0.02, -0.02) - 0.5 * d, d);
  EXPECT_EQ(contact.move(m, 1), 0);
  auto inside = motion<2>({0, 1}, {0, -2});
  EXPECT_GT(contact.move(inside, 1), 0);
  EXPECT_GT(inside.position.y(), 0);
}

TEST(Contact, LeftOfASegmentIsInFront) {
  const auto contact = contact_with<2>({chain({{-1, 0}, {1, 0}}, false, {1, 1})});
  auto above = motion<2>({0, 0.5}, {0, -1}), below = motion<2>({0, -0.5}, {0, 1});
  EXPECT_EQ(contact.move(above, 1), 1);
  EXPECT_EQ(contact.move(below, 1), 0);
}

// --- Sliding and resting --------------------------------------------------------------------------------------------

TEST(Contact, NoBumpsAtTheEdgesInsideAFloor) {
  const auto floor = contact_with<3>({terrain(20, [](int, int) { return 0.0; }, {0, 1})});
  for (const double angle : {0.0, M_PI / 4, 0.3, 1.1}) {  // along edges, through vertices, across
    auto m = motion<3>({1, 1, radius + skin}, {std::cos(angle), std::sin(angle), 0});
    const Point<3> start = m.position, along = m.velocity;
    for (int step = 0; step < 15000; ++step) {
      m.velocity.z() = m.rate.z() -= 9.81e-3;
      floor.move(m, 1e-3);
      ASSERT_NEAR(m.position.z(), radius, 2 * skin);
    }
    EXPECT_NEAR((m.velocity - along).norm(), 0, 1e-9);
    EXPECT_NEAR((m.position - start - 15 * along).norm(), 0, 1e-7);
  }
}

TEST(Contact, NoBumpsOnATiltedFloor) {
  // Turned by any angle and moved away, the floor's corners are rounded: neighbours are no longer exactly in a plane.
  Random<3> random(15);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(random.uniform(0, 3), random.unit()).toRotationMatrix();
    const Point<3> away = random.point(i < 5 ? 1 : 1000);
    Wall<3> floor = terrain(20, [](int, int) { return 0.0; }, {0, 1});
    for (auto& v : floor.vertices) v = turn * v + away;
    const auto contact = contact_with<3>({floor});
    const Point<3> along = turn * Point<3>(1, random.uniform(0, 1), 0);
    auto m = motion<3>(turn * Point<3>(1, 1, radius + skin) + away, along);
    for (int step = 0; step < 1500; ++step) {
      m.velocity = m.rate -= turn.col(2) * 9.81e-2;
      contact.move(m, 1e-2);
      ASSERT_NEAR((turn.transpose() * (m.position - away)).z(), radius, 2 * skin);
    }
    EXPECT_NEAR((m.velocity - along).norm(), 0, 1e-8);
  }
}

TEST(Contact, NoBumpsWhereAFastParticleLands) {
  Random<3> random(8);
  const auto floor = contact_with<3>({terrain(20, [](int, int) { return 0.0; }, {0, 1})});
  for (int i = 0; i < 20000; ++i) {
    Point<3> target = (random.point(9) + Point<3>(10, 10, 0));
    if (i % 2) target = target.array().round();  // a vertex
    if (i % 4 == 1) target.y() = target.x();     // on a diagonal
    target.z() = radius;
    const Point<3> v(random.uniform(), random.uniform(), -random.scale(1e-3, 10));
    auto m = motion<3>(target - 0.5 * v, v);
    floor.move(m, 0.6);
    ASSERT_NEAR((m.velocity - Point<3>(v.x(), v.y(), 0)).norm(), 0, 1e-9 * v.norm());
    ASSERT_NEAR(m.position.z(), radius, 2 * skin);
  }
}

TEST(Contact, RestsForever) {
  const auto contact =
      contact_with<3>({terrain(4, [](int, int) { return 0.0; }, {0, 1}), plane<3>({0, 0, -1}, {0, 0, 1})});
  auto m = motion<3>({2.5, 1, radius + 0.01}, {0, 0, 0});  // over an edge
  double highest = 0, lowest = 1;
  for (int step = 0; step < 1000000; ++step) {
    m.velocity.z() = m.rate.z() -= 9.81e-4;
    contact.move(m, 1e-4);
    if (step < 1000) continue;
    highest = std::max(highest, m.position.z());
    lowest = std::min(lowest, m.position.z());
  }
  EXPECT_NEAR(highest, radius, 2 * skin);
  EXPECT_NEAR(lowest, radius, 2 * skin);
  EXPECT_EQ(m.position.head<2>(), Point<2>(2.5, 1));
}

TEST(Contact, CreepsWithoutLoss) {
  // Down a slope of 30° at slip 1: the path of a frictionless block.
  const Point<2> n(std::sin(M_PI / 6), std::cos(M_PI / 6)), down(n.y(), -n.x());
  const auto contact = contact_with<2>({plane<2>({0, 0}, n, {0, 1})});
  auto m = motion<2>(n * (radius + skin), {0, 0});
  const double dt = 1e-4;
  for (int step = 0; step < 100000; ++step) {
    m.velocity.y() -= 9.81 * dt;
    m.rate = m.velocity;
    contact.move(m, dt);
    m.velocity = m.rate;
  }
  EXPECT_NEAR(m.velocity.dot(down), 9.81 * 0.5 * 10, 1e-6);
  EXPECT_NEAR(m.position.dot(down), 0.5 * 9.81 * 0.5 * 100, 1e-2);
  EXPECT_NEAR(m.position.dot(n), radius, 2 * skin);
}

TEST(Contact, SlipScalesOncePerContact) {
  const auto contact = contact_with<2>({plane<2>({0, 0}, {0, 1}, {0, 0.9})});
  auto m = motion<2>({0, radius + skin}, {1, 0});
  for (int step = 1; step <= 10; ++step) {
    m.velocity.y() = m.rate.y() = -1;
    contact.move(m, 1e-3);
    EXPECT_NEAR(m.velocity.x(), std::pow(0.9, step), 1e-12);
  }
}

TEST(Contact, SlidesAlongTheCreaseOfAChannel) {
  for (const double slope : {0.05, 0.5, 1.0, 3.0}) {  // half-angles of 87° to 18°
    Wall<3> channel;
    channel.vertices = {{-1, 0, slope}, {0, 0, 0}, {1, 0, slope}, {-1, 10, slope}, {0, 10, 0}, {1, 10, slope}};
    channel.facets = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    channel.response = {0, 1};
    const auto contact = contact_with<3>({channel});
    auto m = motion<3>({0.01, 1, 2 * radius * std::hypot(1, slope)}, {0, 1, 0});
    for (int step = 0; step < 8000; ++step) {
      m.velocity.z() = m.rate.z() -= 9.81e-3;
      contact.move(m, 1e-3);
      ASSERT_GT(contact.signed_distance(m.position, 1), radius - skin);
    }
    EXPECT_NEAR(m.velocity.y(), 1, 1e-6) << slope;
    EXPECT_NEAR(m.position.y(), 9, 1e-4) << slope;
  }
}

TEST(Contact, RollsOverAConvexEdge) {
  const auto contact = contact_with<3>({box(1, false, {0, 1})});
  auto m = motion<3>({0, 0.3, 1 + radius + skin}, {1, 0, 0});
  for (int step = 0; step < 2000; ++step) {
    m.velocity.z() = m.rate.z() -= 9.81e-3;
    contact.move(m, 1e-3);
    ASSERT_GE(contact.signed_distance(m.position, 2), radius - skin);
  }
  EXPECT_GT(m.position.x(), 1 + radius);
  EXPECT_LT(m.position.z(), -1);
}

// --- Friction -------------------------------------------------------------------------------------------------------

/// How fast (m/s) a particle goes after 10 s on a slope of 30 degrees with gravity 9.81 m/s².
double speed_down_a_slope(const Response::Grip& grip, double dt) {
  const Point<2> n(std::sin(M_PI / 6), std::cos(M_PI / 6)), down(n.y(), -n.x());
  const auto contact = contact_with<2>({plane<2>({0, 0}, n, {0, 0, grip})});
  auto m = motion<2>(n * (radius + skin), {0, 0});
  for (int step = 0; step * dt < 10 - dt / 2; ++step) {
    m.velocity.y() -= 9.81 * dt;
    m.rate = m.velocity;
    contact.move(m, dt);
    EXPECT_NEAR(m.position.dot(n), radius, 2 * skin);
  }
  return m.velocity.dot(down);
}

TEST(ContactFriction, CoulombBrakesInProportionToTheNormalForce) {
  const double along = 9.81 * std::sin(M_PI / 6), across = 9.81 * std::cos(M_PI / 6);
  for (const double dt : {1e-3, 1e-4}) {
    EXPECT_NEAR(speed_down_a_slope({0.3, 0}, dt), 10 * (along - 0.3 * across), 1e-6);
    EXPECT_NEAR(speed_down_a_slope({0, 0}, dt), 10 * along, 1e-6);
    EXPECT_EQ(speed_down_a_slope({0.6, 0}, dt), 0) << "above tan 30° it rests";
  }
}

TEST(ContactFriction, SticksBelowTheYieldStressAndIsDraggedBeyond) {
  const double along = 9.81 * std::sin(M_PI / 6), across = 9.81 * std::cos(M_PI / 6);
  for (const double dt : {1e-3, 1e-4}) {
    EXPECT_EQ(speed_down_a_slope({0, 1.01 * along}, dt), 0);
    EXPECT_NEAR(speed_down_a_slope({0, 0.6 * along}, dt), 10 * 0.4 * along, 1e-6);
    EXPECT_NEAR(speed_down_a_slope({0.2, 0.3 * along}, dt), 10 * (0.7 * along - 0.2 * across), 1e-6);
  }
}

TEST(ContactFriction, ABounceLosesInProportionToItsImpulse) {
  const auto contact = contact_with<2>({plane<2>({0, 0}, {0, 1}, {0.5, 0, Response::Grip{0.2, 0}})});
  auto m = motion<2>({0, 1 + radius}, {3, -4});
  contact.move(m, 1.0);
  EXPECT_NEAR((m.velocity - Point<2>(3 - 0.2 * 1.5 * 4, 2)).norm(), 0, 1e-12);
  auto slow = motion<2>({0, 1 + radius}, {1, -4});
  contact.move(slow, 1.0);
  EXPECT_NEAR((slow.velocity - Point<2>(0, 2)).norm(), 0, 1e-12) << "never reversed";
}

// --- Corners and gaps -----------------------------------------------------------------------------------------------

TEST(Contact, PressedIntoACornerStaysInside) {
  for (const auto& response : responses) {
    const auto contact = contact_with<3>({box(1, true, response)});
    auto m = motion<3>({0.5, 0.6, 0.7}, {0, 0, 0});
    for (int step = 0; step < 3000; ++step) {
      m.velocity += 0.1 * Point<3>(3, 2, 1);
      m.rate = m.velocity;
      contact.move(m, 0.01);
      ASSERT_LE(m.position.lpNorm<Eigen::Infinity>(), 1 - radius + skin);
    }
  }
}

TEST(Contact, ASqueezedParticleStaysBetween) {
  // A gap of half a diameter, and a wedge of 10°: no room, but never on the other side.
  const auto gap = contact_with<2>({plane<2>({0, 0}, {0, 1}, {0, 1}), plane<2>({0, radius}, {0, -1}, {0, 1})});
  auto m = motion<2>({0, 0.9 * radius}, {1, 3});
  for (int step = 0; step < 1000; ++step) {
    m.velocity.y() = m.rate.y() = step % 2 ? 3 : -3;
    gap.move(m, 0.01);
    ASSERT_NEAR(m.position.y(), 0.5 * radius, 1e-3 * radius);
  }
  EXPECT_NEAR(m.position.x(), 10, 1e-6) << "slides along the gap";

  const auto wedge = contact_with<2>({chain({{2, std::tan(0.087) * 2}, {0, 0}}, false, {0, 1}),
                                      chain({{0, 0}, {2, -std::tan(0.087) * 2}}, false, {0, 1})});
  // Fronts face the wedge's inside, which is to the left of 2 → 0 (below it) and of 0 → 2 (above it).
  auto w = motion<2>({0.3, 0}, {0, 0});
  for (int step = 0; step < 1000; ++step) {
    w.velocity.x() = w.rate.x() = -5;
    wedge.move(w, 0.01);
    ASSERT_LT(std::abs(w.position.y()), std::tan(0.087) * w.position.x());
  }
}

TEST(Contact, NoBumpsInAGapTooNarrow) {
  const auto floor = terrain(8, [](int, int) { return 0.0; }, {0, 1});
  auto ceiling = terrain(8, [](int, int) { return 1.5 * radius; }, {0, 1});
  for (auto& f : ceiling.facets) std::swap(f[1], f[2]);
  const auto contact = contact_with<3>({floor, ceiling});
  auto m = motion<3>({1, 1.1, 0.75 * radius}, {1, 0.7, 0});
  for (int step = 0; step < 5000; ++step) {
    m.velocity.z() = m.rate.z() = step % 2 ? 0.3 : -0.2;
    contact.move(m, 1e-3);
    ASSERT_NEAR(m.position.z(), 0.75 * radius, 1e-3 * radius);
  }
  EXPECT_NEAR((m.position - Point<3>(6, 4.6, 0.75 * radius)).norm(), 0, 1e-6);
  EXPECT_NEAR((m.velocity - Point<3>(1, 0.7, 0)).norm(), 0, 1e-9);
}

TEST(Contact, WallsThatMeetHoldTogether) {
  // Separate walls, given as a soup without shared vertices, with their own responses.
  const auto floor = triangle({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1});
  const auto side = triangle({1, -1, 0}, {1, -1, 2}, {1, 1, 0}, {1, 1});
  const auto contact = contact_with<3>({floor, side});
  auto m = motion<3>({0.5, -0.4, radius + skin}, {1, 0, -0.001});
  contact.move(m, 1);
  EXPECT_NEAR(m.velocity.x(), -1, 1e-9);
  EXPECT_NEAR(m.position.x(), 0.95 - 0.55, 1e-6);
}

// --- The rest of the interface --------------------------------------------------------------------------------------

TEST(Contact, SignedDistance) {
  const auto contact = contact_with<3>({box(1, false)});
  EXPECT_NEAR(contact.signed_distance({0, 0, 1.3}, 2), 0.3, 1e-12);
  EXPECT_NEAR(contact.signed_distance({0, 0, 0.9}, 2), -0.1, 1e-12);
  EXPECT_NEAR(contact.signed_distance({1.3, 1.4, 0}, 2), 0.5, 1e-12);
  EXPECT_NEAR(contact.signed_distance({2, 2, 2}, 2), std::sqrt(3), 1e-12);
  EXPECT_EQ(contact.signed_distance({0, 0, 0}, 0.5), 0.5);
  EXPECT_NEAR(contact.signed_distance({50, 0, 0}, 100), 49, 1e-12);
}

/// Falls onto a belt and is looked at after the impact.
Point<3> after_a_belt(Response response, const Point<3>& belt, const Point<3>& v) {
  auto wall = plane<3>({0, 0, 0}, {0, 0, 1}, response);
  wall.skin.velocity = belt;
  const auto contact = contact_with<3>({wall});
  auto m = motion<3>({0, 0, 2 * radius}, v);
  EXPECT_EQ(contact.move(m, 1), 1);
  return m.velocity;
}

TEST(Contact, ABeltGivesItsVelocityAlongItself) {
  const Point<3> v(1, 0, -1);
  EXPECT_LT((after_a_belt({0.5, 0}, {3, 2, 0}, v) - Point<3>(3, 2, 0.5)).norm(), 1e-12) << "no slip, on the belt";
  EXPECT_LT((after_a_belt({0.5, 1}, {3, 2, 0}, v) - Point<3>(1, 0, 0.5)).norm(), 1e-12) << "free slip";
  EXPECT_LT((after_a_belt({0.5, 0.25}, {3, 2, 0}, v) - Point<3>(2.5, 1.5, 0.5)).norm(), 1e-12);
  EXPECT_LT((after_a_belt({0.5, 0}, {3, 2, -7}, v) - Point<3>(3, 2, 0.5)).norm(), 1e-12)
      << "the belt itself stays where it is";
  // Friction acts on the velocity relative to the belt's, (−4, 0): the impulse is 1.5, a quarter of it drags.
  EXPECT_LT((after_a_belt({0.5, 0, Response::Grip{0.25, 0}}, {5, 0, 0}, v) - Point<3>(1.375, 0, 0.5)).norm(), 1e-12);
}

TEST(Contact, MayTouchNeverLies) {
  Random<3> random(4);
  const auto contact = contact_with<3>(
      {terrain(6, [&](int, int) { return random.uniform(0, 0.5); }, {1, 1}), plane<3>({3, 3, 5}, {0, 0, -1})});
  int far = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point<3> x(random.uniform(-1, 7), random.uniform(-1, 7), random.uniform(-1, 6)),
        d = random.scale(0.01, 2) * random.unit();
    if (contact.may_touch(x, d.norm())) continue;
    ++far;
    auto m = motion<3>(x, d);
    ASSERT_EQ(contact.move(m, 1), 0);
    ASSERT_GE(std::abs(contact.signed_distance(x, 10 * radius)), radius);
  }
  EXPECT_GT(far, 8000);
}

TEST(Contact, NoWallWithinTheFreeWay) {
  Random<3> random(5);
  const auto contact = contact_with<3>(
      {terrain(6, [&](int, int) { return random.uniform(0, 0.5); }, {1, 1}), plane<3>({3, 3, 5}, {0, 0, -1})});
  const double limit = 3 * radius;
  int free = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point<3> x(random.uniform(0, 6), random.uniform(0, 6), random.uniform(0, 1));
    const double way = contact.free_way(x, limit);
    const double gap = std::abs(contact.signed_distance(x, limit + 2 * radius)) - radius;
    ASSERT_NEAR(way, std::clamp(gap, 0.0, limit), 1e-6 * radius);
    if (way == 0) continue;
    ++free;
    auto m = motion<3>(x, 0.999999 * way * random.unit());
    ASSERT_EQ(contact.move(m, 1), 0);
  }
  EXPECT_GT(free, 8000);
}

TEST(Contact, EmptyAndBadInput) {
  const auto none = contact_with<3>({});
  EXPECT_TRUE(none.empty());
  EXPECT_FALSE(none.may_touch({0, 0, 0}, 1));
  auto m = motion<3>({0, 0, 0}, {1, 0, 0});
  EXPECT_EQ(none.move(m, 1), 0);
  EXPECT_EQ(m.position.x(), 1);
  EXPECT_EQ(none.signed_distance({0, 0, 0}, 3), 3);

  Wall<3> bad = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  bad.facets[0][1] = 7;
  EXPECT_THROW(contact_with<3>({bad}), Error);
  EXPECT_THROW(contact_with<3>({triangle({0, 0, NAN}, {1, 0, 0}, {0, 1, 0})}), Error);
  EXPECT_THROW(contact_with<3>({plane<3>({0, 0, 0}, {0, 0, 0})}), Error);
  EXPECT_THROW(contact_with<3>({}, 0), Error);
}

TEST(Contact, NotFiniteIsPassedOn) {
  const auto contact = contact_with<3>({box(1, true)});
  auto m = motion<3>({0, 0, 0}, {NAN, 0, 0});
  EXPECT_EQ(contact.move(m, 1), 0);
  auto n = motion<3>({NAN, 0, 0}, {1, 0, 0});
  EXPECT_EQ(contact.move(n, 1), 0);
}

TEST(Contact, AbsurdlyFastIsHeld) {
  const auto contact = contact_with<3>({box(1, true), plane<3>({0, 0, -0.5}, {0, 0, 1})});
  for (const Point<3>& way : {Point<3>(1, 1, 0), Point<3>(1, 1, -1), Point<3>(0.3, 0.2, 0.9), Point<3>(0.1, 0, -1)}) {
    auto m = motion<3>({0, 0, 0}, 1e100 * way);
    EXPECT_GT(contact.move(m, 1), 0);
    EXPECT_LT(m.position.lpNorm<Eigen::Infinity>(), 1 - radius + skin);
    EXPECT_GT(m.position.z(), -0.5 + radius - skin);
  }
}

/// No particle in a box may touch a wall that the box did not hear of; the same by grid and by tree.
TEST(Contact, BoxHearsOfWallsNearItsPoints) {
  for (const SearchMethod method : {SearchMethod::grid, SearchMethod::tree}) {
    Random<3> random(31);
    const double radius = 0.05;
    const Contact<3> contact({contact_test::box(1, true), contact_test::plane<3>({0, 0, 3}, {0, 0, -1})}, radius, 0.3,
                             method);
    int none = 0;
    for (int i = 0; i < 3000; ++i) {
      const Point<3> middle = random.point(3), half = random.point().cwiseAbs() * 0.3;
      const double reach = random.scale(0.01, 0.3);
      if (contact.may_touch_in(middle - half, middle + half, reach)) continue;
      ++none;
      const Point<3> x = middle + half.cwiseProduct(random.point());
      ASSERT_GE(std::abs(contact.signed_distance(x, 1)), radius + reach);
    }
    EXPECT_GT(none, 500);
  }
}

}  // namespace
}  // namespace molten::contact_test
