// The walls that a particle touches at the same moment, and what becomes of its velocity there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/boundary/impact.h"
#include "core/boundary/sweep.h"

namespace molten {

template <int Dim> struct Touch {
  Point<Dim> normal, velocity;  // -, m/s; of the wall
  const Response* response;
  std::int32_t body;
};

template <int Dim> class Touching {
 public:
  static constexpr int most = 8;

  void clear() { count_ = 0; }
  void add(const Touch<Dim>& touch) { touch_[count_++] = touch; }
  const Touch<Dim>& last() const { return touch_[count_ - 1]; }

  /// The full response at the wall that was touched last, after which it is touched for dt (s); then the normal part
  /// alone at walls still touched that the velocity now approaches. gained(touch, change of velocity) tells who changed
  /// it.
  template <class Gained> void respond(Point<Dim>& u, double dt, Gained&& gained) const {
    change(u, last(), after_impact_on(last(), u, dt), gained);
    for (int i = 0; i < most_responses; ++i) {
      const int k = approached(u);
      if (k == count_) return;
      const Touch<Dim>& t = touch_[k];
      const double normal_part = (u - t.velocity).dot(t.normal);
      change(u, t, u - (1 + t.response->restitution) * normal_part * t.normal, gained);
    }
    const int k = approached(u);
    if (k < count_) change(u, touch_[k], along_crease(u, k), gained);
  }

 private:
  static constexpr int most_responses = 8;  // then the velocity is led along the crease between the walls

  template <class Gained>
  static void change(Point<Dim>& u, const Touch<Dim>& touch, const Point<Dim>& to, Gained&& gained) {
    gained(touch, Point<Dim>(to - u));
    u = to;
  }

  static Point<Dim> after_impact_on(const Touch<Dim>& t, const Point<Dim>& u, double dt) {
    const auto vec = [](const Point<Dim>& x) {
      Vec<Dim, double> v;
      Eigen::Map<Point<Dim>>(v.c.data()) = x;
      return v;
    };
    const auto after = after_impact(vec(u), vec(t.normal), vec(t.velocity), *t.response, dt);
    return Eigen::Map<const Point<Dim>>(after.c.data());
  }

  bool is_approached(const Point<Dim>& u, int k) const {
    return approaches<Dim>(u - touch_[k].velocity, touch_[k].normal);
  }
  int approached(const Point<Dim>& u) const {
    int k = 0;
    while (k < count_ && !is_approached(u, k)) ++k;
    return k;
  }

  /// What is left of u when it may approach none of the walls, `a` being one that it does: along that wall, along the
  /// crease of two, or that wall's own velocity.
  Point<Dim> along_crease(const Point<Dim>& u, int a) const {
    const Point<Dim>&n = touch_[a].normal, &w = touch_[a].velocity, relative = u - w;
    const Point<Dim> slide = u - relative.dot(n) * n;
    if (approached(slide) == count_) return slide;
    if constexpr (Dim == 3) {
      for (int b = 0; b < count_; ++b) {
        const Point<3> crease = n.cross(touch_[b].normal);
        if (crease.squaredNorm() < 1e-20) continue;
        const Point<3> along = w + crease * (crease.dot(relative) / crease.squaredNorm());
        if (approached(along) == count_) return along;
      }
    }
    return w;
  }

  std::array<Touch<Dim>, most> touch_;
  int count_ = 0;
};

}  // namespace molten
