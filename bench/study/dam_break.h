// Columns of water that collapse in a tank, in 2-D and 3-D; the column stands against the wall at x = 0.
#pragma once

#include <cstddef>

#include "bench/study/metrics.h"
#include "bench/study/simulation.h"

namespace molten::study {

struct DamBreak {
  int dimensions = 2;
  Triple column{}, tank{};  // m; sizes along x, y (up in 2-D), z (up in 3-D)
  double spacing = 0;       // m
  double slip = 1;          // of the walls
  double gate = 0;          // speed at which a gate before the column rises, m/s; 0: none. In 2-D
  double perturbation = 0;  // width of the random displacements at the start, spacings
  double stagger = 0;       // in 3-D: width of the displacements of slices, spacings
};

/// At rest, with hydrostatic pressure.
Setup dam_break(const DamBreak& d);

/// The case's parameter of that name. Lobovský et al. (2014) measured theirs: 4.53 m/s is the median.
Parameter gate_parameter(double speed = 0);
/// Its value; 0 with the presets whose integrators know no moving walls.
double gate_of(const Request& request);
/// The width of the displacements: water has no lattice. Rows of one arrive at a wall together, and its pressure rings.
Parameter perturbation_parameter();
/// A gate whose face towards the column is at `left` (m), from the floor to `top` (m), in 2-D.
std::string gate_text(double left, double top, double spacing, double speed);

/// The front (m from the closed wall): the far side of the fifth-farthest particle, so that a few drops don't count, or
/// of another one.
double front_of(const Cloud& cloud, std::ptrdiff_t farthest = 5);

/// Judges a series against an experiment: relative rms raw, `NAME_raw`, and after the best shift in time,
/// `NAME_shifted`, and that shift over the experiment's duration, `NAME_time_shift`.
void expect_series(Report& report, const std::string& name, double raw_reach, double shifted_reach);
void judge_series(Report& report, const std::string& name, const Series& run, const Series& experiment);

}  // namespace molten::study
