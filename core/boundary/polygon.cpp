#include "core/boundary/polygon.h"

#include <algorithm>
#include <cmath>

namespace molten {
namespace {

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

int sign(double value) { return (value > 0) - (value < 0); }

bool on_segment(const Vec2& a, const Vec2& b, const Vec2& p) { return turn(a, b, p) == 0 && (p - a).dot(p - b) <= 0; }

bool touch(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  if (sign(turn(a, b, c)) * sign(turn(a, b, d)) < 0 && sign(turn(c, d, a)) * sign(turn(c, d, b)) < 0) return true;
  return on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b);
}

std::string text(const Vec2& p) { return "(" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ")"; }

bool is_ear(const std::vector<Vec2>& points, const std::vector<std::int32_t>& left, std::size_t k) {
  const std::size_t n = left.size(), before = (k + n - 1) % n, after = (k + 1) % n;
  const Vec2 &a = points[left[before]], &b = points[left[k]], &c = points[left[after]];
  if (turn(a, b, c) <= 0) return false;
  for (std::size_t m = 0; m < n; ++m) {
    if (m == before || m == k || m == after) continue;
    const Vec2& p = points[left[m]];
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

std::string polygon_defect(const std::vector<Vec2>& points) {
  const std::size_t n = points.size();
  if (n < 3) return "needs at least 3 points";
  for (std::size_t i = 0; i < n; ++i)
    if (!points[i].allFinite()) return "point " + std::to_string(i + 1) + " is not finite";
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 &a = points[i], &b = points[(i + 1) % n], &c = points[(i + 2) % n];
    if (a == b) return "has the point " + text(a) + " twice in a row";
    if (turn(a, b, c) == 0 && (b - a).dot(c - b) < 0) return "turns back on itself at " + text(b);
    for (std::size_t j = i + 2; j < n; ++j) {
      if ((j + 1) % n == i) continue;
      if (touch(a, b, points[j], points[(j + 1) % n]))
        return "crosses or touches itself: edge " + std::to_string(i + 1) + " from " + text(a) + " and edge " +
               std::to_string(j + 1) + " from " + text(points[j]);
    }
  }
  return twice_area(points) == 0 ? "encloses no area" : "";
}

double twice_area(const std::vector<Vec2>& points) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) twice += turn(points[0], points[i], points[i + 1]);
  return twice;
}

std::vector<std::array<std::int32_t, 3>> clip_ears(const std::vector<Vec2>& points) {
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> left(points.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = static_cast<std::int32_t>(i);
  std::size_t k = 0;
  for (std::size_t tries = 0; left.size() > 3;) {
    const std::size_t n = left.size();
    // After a full round without an ear only straight corners remain, up to rounding: cut anyhow, the area is nil.
    if (is_ear(points, left, k) || tries >= n) {
      triangles.push_back({left[(k + n - 1) % n], left[k], left[(k + 1) % n]});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
      tries = 0;
    } else {
      ++tries;
      ++k;
    }
    k %= left.size();
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace molten
