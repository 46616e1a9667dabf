// Nothing gets through a wall: random tanks, terrains and thin walls, slow and up to thousands of radii a step.
#include <gtest/gtest.h>

#include <thread>

#include "core/boundary/contact.h"
#include "tests/contact_shapes.h"

namespace molten::contact_stress_test {
namespace {

using namespace contact_test;

constexpr double radius = 0.05, skin = 1e-8 * radius;
const std::vector<Response> responses = {{0, 0}, {0, 1}, {1, 1}, {0.5, 0.5}, {1, 0}, {0.9, 1}, {0, 0.7}};

Wall<2> tank(Random<2>&, Response r) { return square(1, true, r); }
Wall<3> tank(Random<3>&, Response r) { return box(1, true, r); }

/// Random velocities, also of 1000 radii a step, in a closed tank: never closer to a wall than the radius.
template <int Dim> void nothing_leaves_a_tank() {
  Random<Dim> random(Dim);
  double nearest = 1;
  for (const Response& response : responses) {
    const Contact<Dim> contact({tank(random, response)}, radius, 5 * radius);
    for (int particle = 0; particle < 100; ++particle) {
      Motion<Dim> m{random.point(0.9), random.point(), random.point()};
      for (int step = 0; step < 500; ++step) {
        if (step % 10 == 0) m.velocity = random.scale(1e-6, 1e3 * radius) * random.unit();
        if (step % 50 == 1) m.velocity = random.point().array().sign() * random.scale(0.01, 30);  // into the corners
        m.rate = m.velocity + 0.1 * random.uniform(0, 1) * random.point();
        contact.move(m, 1);
        nearest = std::min(nearest, 1 - m.position.template lpNorm<Eigen::Infinity>());
        ASSERT_GT(nearest, radius - 10 * skin) << m.position.transpose();
      }
    }
  }
}

TEST(ContactStress, NothingLeavesATank) {
  nothing_leaves_a_tank<2>();
  nothing_leaves_a_tank<3>();
}

/// A closed mesh with convex and concave, sharp and flat edges, seen from outside: distances are to its true surface.
Wall<3> star(Random<3>& random, Response response, bool inwards) {
  Wall<3> wall = box(1, inwards, response);
  for (int round = 0; round < 2; ++round) {  // raise a tip of random height over each facet
    std::vector<std::array<std::int32_t, 3>> facets;
    for (const auto& f : wall.facets) {
      const auto tip = static_cast<std::int32_t>(wall.vertices.size());
      const Point<3>&a = wall.vertices[f[0]], &b = wall.vertices[f[1]], &c = wall.vertices[f[2]];
      wall.vertices.push_back(Point<3>((a + b + c) / 3 * random.uniform(0.9, round ? 1.05 : 1.5)));
      for (int k = 0; k < 3; ++k) facets.push_back({f[k], f[(k + 1) % 3], tip});
    }
    wall.facets = facets;
  }
  return wall;
}

TEST(ContactStress, NothingEntersOrLeavesASpikyBody) {
  Random<3> random(77);
  for (const bool inwards : {false, true})
    for (const Response& response : responses) {
      const Contact<3> contact({star(random, response, inwards)}, radius, 5 * radius);
      for (int particle = 0; particle < 100; ++particle) {
        Motion<3> m;
        do m.position = random.point(inwards ? 0.8 : 4);
        while (contact.signed_distance(m.position, 10) < radius);
        for (int step = 0; step < 200; ++step) {
          m.velocity = random.scale(0.001, 100) * (random.unit() - 0.05 * (inwards ? 0 : 1) * m.position);
          m.rate = m.velocity;
          contact.move(m, 0.1);
          ASSERT_GT(contact.signed_distance(m.position, 0.1), 0) << m.position.transpose();
          if (m.position.norm() > 6) m.position *= 5 / m.position.norm();
        }
      }
    }
}

TEST(ContactStress, NothingTunnelsThroughOneThinTriangle) {
  Random<3> random(9);
  const Point<3> a(-1, -1, 0), b(1, -1, 0), c(0, 1, 0);
  const Contact<3> contact({triangle(a, b, c, {0, 1})}, radius, 5 * radius);
  for (int i = 0; i < 50000; ++i) {
    double u = random.uniform(0, 1), v = random.uniform(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Point<3> target = a + u * (b - a) + v * (c - a);
    const Point<3> d = 2000 * radius * Point<3>(random.uniform(), random.uniform(), -random.scale(0.01, 1));
    Motion<3> m{target - random.uniform(0.2, 0.8) * d, d, d};
    if (m.position.z() < radius) continue;
    ASSERT_GT(contact.move(m, 1), 0);
    ASSERT_GT(m.position.z(), 0) << "slid off over the rim, or is still above";
  }
}

/// Height of the terrain under x; NaN beyond it.
double height_under(const Wall<3>& wall, const Point<3>& x) {
  for (const auto& f : wall.facets) {
    const Point<3>&a = wall.vertices[f[0]], &b = wall.vertices[f[1]], &c = wall.vertices[f[2]];
    const auto cross = [](const Point<3>& p, const Point<3>& q) { return p.x() * q.y() - p.y() * q.x(); };
    const double w = cross(b - a, c - a), s = cross(x - a, c - a) / w, t = cross(b - a, x - a) / w;
    if (s >= 0 && t >= 0 && s + t <= 1) return a.z() + s * (b.z() - a.z()) + t * (c.z() - a.z());
  }
  return NAN;
}

TEST(ContactStress, RainOnATerrainStaysAbove) {
  Random<3> random(31);
  for (const double roughness : {0.3, 3.0}) {
    const int n = 12;
    const Wall<3> hills = terrain(n, [&](int, int) { return random.uniform(0, roughness); }, {0, 0.9});
    std::vector<Wall<3>> walls = {hills};  // with walls around it
    for (int axis = 0; axis < 2; ++axis)
      for (const double end : {0.0, double(n)})
        walls.push_back(plane<3>(end * Point<3>::Unit(axis), (end > 0 ? -1 : 1) * Point<3>::Unit(axis), {0.3, 1}));
    const Contact<3> contact(walls, radius, 5 * radius);
    int bounces = 0;
    for (int drop = 0; drop < 2000; ++drop) {
      const double v = random.scale(0.1, 100);
      Motion<3> m{{random.uniform(1, n - 1), random.uniform(1, n - 1), roughness + 2}, v * random.unit(), {}};
      for (int step = 0; step < 150; ++step) {
        m.velocity.z() -= 9.81 * 0.02;
        m.rate = m.velocity + 0.1 * random.point();
        bounces += contact.move(m, 0.02);
        if (m.position.z() > roughness + 3) continue;
        ASSERT_GT(m.position.z(), height_under(hills, m.position)) << m.position.transpose();
        if (step % 10 == 0) {
          ASSERT_GT(contact.signed_distance(m.position, 2 * radius), radius * (1 - 1e-6));
        }
      }
    }
    EXPECT_GT(bounces, 50000);
  }
}

/// The same with corners of every angle in 2-D: a random polygon, walked inside.
TEST(ContactStress, NothingLeavesARandomPolygon) {
  Random<2> random(13);
  for (int shape = 0; shape < 240; ++shape) {
    std::vector<Point<2>> corner;
    const int n = 3 + shape % 12;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * M_PI * (i + random.uniform(-0.3, 0.3)) / n;
      corner.push_back(random.uniform(0.3, 1.5) * Point<2>(std::cos(angle), std::sin(angle)));
    }
    const Contact<2> contact({chain(corner, true, responses[shape % responses.size()])}, radius, 5 * radius);
    Motion<2> m{{0, 0}, {0, 0}, {0, 0}};
    if (contact.signed_distance(m.position, 1) < radius) continue;
    for (int step = 0; step < 3000; ++step) {
      if (step % 20 == 0) m.velocity = random.scale(0.01, 1000 * radius) * random.unit();
      m.velocity.y() -= 0.01;
      m.rate = m.velocity;
      contact.move(m, 1);
      ASSERT_GT(contact.signed_distance(m.position, 1), 0) << "shape " << shape;
    }
  }
}

/// Far from the origin round-off is larger than the usual gap.
TEST(ContactStress, HoldsFarFromTheOrigin) {
  Random<3> random(2);
  const double r = 1e-3;
  const Point<3> far(1e4, -1e4, 500);
  Wall<3> wall = box(50 * r, true, {0, 1});
  for (auto& v : wall.vertices) v += far;
  const Contact<3> contact({wall}, r, 5 * r);
  Motion<3> m{far, {0, 0, 0}, {0, 0, 0}};
  for (int step = 0; step < 100000; ++step) {
    if (step % 50 == 0) m.velocity = random.scale(1e-3, 1) * random.unit();
    m.velocity.z() -= 9.81e-4;
    m.rate = m.velocity;
    contact.move(m, 1e-3);
    ASSERT_LT((m.position - far).lpNorm<Eigen::Infinity>(), 49 * r + 1e-6 * r);
  }
}

TEST(ContactStress, TheThreadDoesNotMatter) {
  Random<3> random(21);
  const auto hills = terrain(8, [&](int, int) { return random.uniform(0, 1); }, {0.5, 0.9});
  const Contact<3> contact({hills, plane<3>({0, 0, 4}, {0, 0, -1}, {0.5, 0.9})}, radius, 5 * radius);
  std::vector<Motion<3>> a;
  for (int i = 0; i < 500; ++i)
    a.push_back({random.point(3) + Point<3>(4, 4, 2), 5 * random.point(), 5 * random.point()});
  auto b = a;
  const auto run = [&](std::vector<Motion<3>>& all, std::size_t from, std::size_t to) {
    for (int step = 0; step < 20; ++step)
      for (std::size_t i = from; i < to; ++i) contact.move(all[i], 0.05);
  };
  run(a, 0, a.size());
  std::thread other([&] { run(b, 0, 200); });
  run(b, 200, b.size());
  other.join();
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].velocity, b[i].velocity);
  }
}

}  // namespace
}  // namespace molten::contact_stress_test
