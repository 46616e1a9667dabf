// A cluster that bounces off one face at once, against the exact sweep of each of its particles.
#include <gtest/gtest.h>

#include "core/cluster_motion.h"
#include "tests/contact_shapes.h"

namespace molten::face_bounce_test {
namespace {

using namespace contact_test;

constexpr double radius = 0.05, reach = 0.5 * radius;

template <int Dim> Contact<Dim> contact_with(std::vector<Wall<Dim>> walls) {
  return Contact<Dim>(std::move(walls), radius, 5 * radius);
}

template <int Dim> using FourParticles = std::array<Motion<Dim>, cluster_size>;

template <int Dim> ClusterMotion<Dim> cluster_of(const FourParticles<Dim>& particles) {
  ClusterMotion<Dim> all;
  for (int d = 0; d < Dim; ++d)
    for (int n = 0; n < cluster_size; ++n) {
      set_lane(all.position[d], n, particles[n].position[d]);
      set_lane(all.velocity[d], n, particles[n].velocity[d]);
      set_lane(all.rate[d], n, particles[n].rate[d]);
    }
  return all;
}

template <int Dim> Point<Dim> lane_of(const Vec<Dim, ClusterLanes>& all, int n) {
  return Point<Dim>::NullaryExpr([&](Eigen::Index d) { return lane(all[static_cast<int>(d)], n); });
}

/// Four particles near x, which go no further than the reach in a time of 1 s; some of them drift (XSPH).
template <int Dim> FourParticles<Dim> some_near(const Point<Dim>& x, Random<Dim>& random) {
  FourParticles<Dim> all;
  for (Motion<Dim>& m : all) {
    m.position = x + radius * random.point();
    m.rate = reach * random.uniform(0, 1) * random.unit();
    m.velocity = random.uniform() < 0 ? m.rate : Point<Dim>(m.rate + 0.1 * reach * random.unit());
  }
  return all;
}

struct Tally {
  int at_once = 0, bounces = 0;
};

/// Compares both ways of moving four particles, where they share the only face that they can meet.
template <int Dim> void compare(const Contact<Dim>& contact, const FourParticles<Dim>& before, Tally& tally) {
  const std::int32_t face = contact.only_face(before[0].position, reach);
  for (const Motion<Dim>& m : before)
    if (face < 0 || (contact.only_face(m.position, reach) != face && contact.free_way(m.position, reach) < reach))
      return;
  ClusterMotion<Dim> all = cluster_of(before);
  const auto bounced = contact.bounce_off(face, all, 1);
  if (!bounced) return;
  ++tally.at_once;
  for (int n = 0; n < cluster_size; ++n) {
    Motion<Dim> m = before[n];
    const int bounces = contact.move(m, 1);
    ASSERT_EQ(lane(*bounced, n), bounces);
    ASSERT_LT((lane_of<Dim>(all.position, n) - m.position).norm(), 1e-13);
    ASSERT_LT((lane_of<Dim>(all.velocity, n) - m.velocity).norm(), 1e-14);
    tally.bounces += bounces;
  }
}

const std::vector<Response> responses = {
    {0, 0}, {0, 1}, {1, 1}, {0.5, 0.5}, {0, 0, Response::Grip{0.3, 0}}, {0.2, 0, Response::Grip{0.2, 0.1 * reach}}};

TEST(FaceBounce, IsTheSweepOfEachParticle) {
  Random<3> random(1);
  for (const Response& response : responses) {
    const auto contact = contact_with<3>({terrain(
                                              6, [&](int, int) { return random.uniform(0, 0.5); }, response),
                                          box(20, true)});
    Tally tally;
    for (int i = 0; i < 100000; ++i)
      compare(contact, some_near<3>({random.uniform(0, 6), random.uniform(0, 6), random.uniform(0, 0.5)}, random),
              tally);
    EXPECT_GT(tally.at_once, 1000);
    EXPECT_GT(tally.bounces, 150);
  }
}

TEST(FaceBounce, IsTheSweepOfEachParticleInAPlane) {
  Random<2> random(2);
  for (const Response& response : responses) {
    const auto contact = contact_with<2>({square(1, true, response)});
    Tally tally;
    for (int i = 0; i < 20000; ++i)
      compare(contact, some_near<2>({1 - radius * random.uniform(1, 3), random.uniform()}, random), tally);
    EXPECT_GT(tally.at_once, 1000);
    EXPECT_GT(tally.bounces, 150);
  }
}

TEST(FaceBounce, ABeltBrakesAtOnceButDrivesOneByOne) {
  Wall<2> belt = chain({{-1, 0}, {1, 0}}, false, {0, 0});
  belt.skin.velocity = {0.2 * reach, 0};
  const auto contact = contact_with<2>({belt});
  const Point<2> start(0, radius + 0.1 * reach);
  FourParticles<2> faster, slower;
  for (int n = 0; n < cluster_size; ++n) {
    const Point<2> v(0.5 * reach, -0.3 * reach), u(0, -0.1001 * reach);
    faster[n] = {start, v, v};
    slower[n] = {start, u, u};
  }
  Tally tally;
  compare(contact, faster, tally);
  EXPECT_EQ(tally.bounces, cluster_size);
  ClusterMotion<2> all = cluster_of(slower);
  EXPECT_FALSE(contact.bounce_off(contact.only_face(start, reach), all, 1)) << "it may get further than was thought";
  EXPECT_EQ(lane_of<2>(all.position, 0), start) << "and nothing has moved";
}

TEST(FaceBounce, LeavesOverlapsToTheSweep) {
  const auto contact = contact_with<3>({box(1, true)});
  for (const double height : {0.5 * radius, -0.5 * radius}) {
    FourParticles<3> particles;
    particles.fill({Point<3>(0.1, 0.3, -1 + 1.2 * radius), Point<3>::Zero(), Point<3>::Zero()});
    particles[2].position.z() = -1 + height;
    ClusterMotion<3> all = cluster_of(particles);
    EXPECT_FALSE(contact.bounce_off(contact.only_face(particles[0].position, reach), all, 1));
  }
}

TEST(FaceBounce, OnlyWhereThereIsNothingElse) {
  const Point<3> over(0.1, 0.3, -1 + radius);
  EXPECT_GE(contact_with<3>({box(1, true)}).only_face(over, reach), 0);
  EXPECT_EQ(contact_with<3>({box(1, true)}).only_face({0.1, 0.3, 0}, reach), -1) << "far from all";
  EXPECT_EQ(contact_with<3>({box(1, true)}).only_face({0.1, -1 + radius, -1 + radius}, reach), -1) << "a corner";
  EXPECT_EQ(contact_with<3>({box(1, true)}).only_face({0.2, 0.2, -1 + radius}, reach), -1) << "between two triangles";
  EXPECT_EQ(contact_with<3>({box(1, true), plane<3>({0, 0, 5}, {0, 0, -1})}).only_face(over, reach), -1) << "a plane";
  Wall<3> body = box(0.1, false);
  body.body = 0;
  EXPECT_EQ(contact_with<3>({box(1, true), body}).only_face(over, reach), -1) << "a body may come";
}

}  // namespace
}  // namespace molten::face_bounce_test
