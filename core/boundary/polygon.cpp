#include "core/boundary/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

std::string text(const Vec2& p) {
  std::string place = "(";
  return place.append(std::to_string(p.x())).append(", ").append(std::to_string(p.y())).append(")");
}

bool is_ear(const std::vector<Vec2>& points, const std::vector<std::int32_t>& left, std::size_t k) {
  const std::size_t n = left.size(), before = (k + n - 1) % n, after = (k + 1) % n;
  const Vec2 &a = points[left[before]], &b = points[left[k]], &c = points[left[after]];
  if (turn(a, b, c) <= 0) return false;
  for (std::size_t m = 0; m < n; ++m) {
    if (m == before || m == k || m == after) continue;
    const Vec2& p = points[left[m]];
    if (p == a || p == b || p == c) continue;  // the other end of a bridge
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

bool rings_touch(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j)
      if (touch(a[i], a[(i + 1) % a.size()], b[j], b[(j + 1) % b.size()])) return true;
  return false;
}

bool goes_round(const std::vector<Vec2>& ring, const Vec2& p) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) && (turn(a, b, p) > 0) == (b.y() > a.y())) inside = !inside;
  }
  return inside;
}

namespace {

using Ring = std::vector<std::int32_t>;  // indices of points

/// Whether the segment between two points meets an edge of the ring that ends at neither of them.
bool is_blocked(const std::vector<Vec2>& points, const Ring& ring, const Vec2& from, const Vec2& to) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 &a = points[ring[i]], &b = points[ring[(i + 1) % ring.size()]];
    if (a != from && a != to && b != from && b != to && touch(a, b, from, to)) return true;
  }
  return false;
}

/// Where in `outer` the bridge to point `from` of a hole begins: the nearest corner that sees it and has no bridge yet.
std::size_t find_bridge(const std::vector<Vec2>& points, const Ring& outer, const std::vector<Ring>& holes,
                        std::int32_t from) {
  std::size_t best = outer.size();
  double shortest = HUGE_VAL;
  for (std::size_t k = 0; k < outer.size(); ++k) {
    const Vec2 &a = points[from], &b = points[outer[k]];
    if ((b - a).squaredNorm() >= shortest || std::count(outer.begin(), outer.end(), outer[k]) > 1) continue;
    const auto blocks = [&](const Ring& ring) { return is_blocked(points, ring, a, b); };
    if (blocks(outer) || std::any_of(holes.begin(), holes.end(), blocks)) continue;
    shortest = (b - a).squaredNorm();
    best = k;
  }
  return best;
}

/// The outline and its holes as one ring. The hole that reaches farthest right comes first, so it sees the outline.
Ring bridge(const std::vector<Vec2>& points, Ring outer, std::vector<Ring> holes) {
  const auto is_left = [&](std::int32_t a, std::int32_t b) { return points[a].x() < points[b].x(); };
  for (Ring& hole : holes) std::rotate(hole.begin(), std::max_element(hole.begin(), hole.end(), is_left), hole.end());
  std::sort(holes.begin(), holes.end(), [&](const Ring& a, const Ring& b) { return is_left(b[0], a[0]); });
  for (const Ring& hole : holes) {
    const std::size_t k = find_bridge(points, outer, holes, hole[0]);
    if (k == outer.size()) continue;  // not for rings that do not touch
    Ring both_ways(hole);
    both_ways.push_back(hole[0]);
    both_ways.push_back(outer[k]);
    outer.insert(outer.begin() + static_cast<std::ptrdiff_t>(k) + 1, both_ways.begin(), both_ways.end());
  }
  return outer;
}

std::vector<std::array<std::int32_t, 3>> clip_ears(const std::vector<Vec2>& points, Ring left) {
  std::vector<std::array<std::int32_t, 3>> triangles;
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

}  // namespace

std::vector<std::array<std::int32_t, 3>> clip_ears(const std::vector<Vec2>& points) {
  return clip_ears(std::vector<std::vector<Vec2>>{points});
}

std::vector<std::array<std::int32_t, 3>> clip_ears(const std::vector<std::vector<Vec2>>& rings) {
  std::vector<Vec2> points;
  std::vector<Ring> indices;
  for (const std::vector<Vec2>& ring : rings) {
    Ring& one = indices.emplace_back(ring.size());
    std::iota(one.begin(), one.end(), static_cast<std::int32_t>(points.size()));
    points.insert(points.end(), ring.begin(), ring.end());
  }
  return clip_ears(points, bridge(points, indices.front(), {indices.begin() + 1, indices.end()}));
}

}  // namespace molten
