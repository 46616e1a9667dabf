// Runge-Kutta methods whose stages each follow from the start and the rates of the stage before:
//   y_s = y_0 + a_s dt Y(y_{s−1}),  y = y_0 + dt Σ b_s Y(y_s).
// Explicit Euler, midpoint, the classical method of order 4, and the predictor-corrector of SPHysics ([D]; Monaghan
// 1989): the midpoint rule that predicts with the rates of the last step's middle, so that it finds rates once a step.
#pragma once

#include <array>

#include "core/state.h"

namespace molten {

struct Tableau {
  int stages = 1;
  std::array<double, 4> a{}, b{1};
};

constexpr Tableau tableau_of(IntegratorKind kind) {
  switch (kind) {
    case IntegratorKind::midpoint:
    case IntegratorKind::predictor_corrector:
      return {2, {0, 0.5}, {0, 1}};
    case IntegratorKind::runge_kutta_4:
      return {4, {0, 0.5, 0.5, 1}, {1. / 6, 1. / 3, 1. / 3, 1. / 6}};
    default:
      return {};
  }
}

/// Takes the particles from stage − 1, whose rates are known, to `stage`; walls are not asked.
template <int Dim, class Real> void go_to_stage(State<Dim, Real>& s, int stage);

/// The whole step from the rates of its stages, bouncing off walls.
template <int Dim, class Real> void finish_stages(State<Dim, Real>& s);

}  // namespace molten
