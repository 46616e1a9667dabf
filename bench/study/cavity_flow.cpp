#include "bench/study/cavity_flow.h"

#include <fmt/format.h>

#include <Eigen/SparseLU>
#include <algorithm>
#include <vector>

#include "core/error.h"

namespace molten::study {

namespace {

/// ∇²ψ + ω = 0 and ∇²ω/Re = u ω_x + v ω_y with u = ψ_y, v = −ψ_x at the inner nodes of a grid.
class Cavity {
 public:
  explicit Cavity(int cells) : cells_(cells), h_(1.0 / cells), inner_((cells - 1) * (cells - 1)), x_(2 * inner_) {
    x_.setZero();
  }

  /// From rest through flows of twice the Reynolds number each: Newton's method goes astray on longer ways.
  void solve(double reynolds) {
    for (double through = std::min(reynolds, 100.0);; through = std::min(2 * through, reynolds)) {
      reynolds_ = through;
      iterate();
      if (through == reynolds) return;
    }
  }

  double u(int j) const {  // at x = ½
    if (j == 0 || j == cells_) return j == 0 ? 0 : 1;
    return (psi(cells_ / 2, j + 1) - psi(cells_ / 2, j - 1)) / (2 * h_);
  }
  double v(int i) const {  // at y = ½
    if (i == 0 || i == cells_) return 0;
    return -(psi(i + 1, cells_ / 2) - psi(i - 1, cells_ / 2)) / (2 * h_);
  }

 private:
  void iterate() {
    for (int round = 0; round < 30; ++round) {
      Eigen::SparseMatrix<double> slopes(2 * inner_, 2 * inner_);
      Eigen::VectorXd residual(2 * inner_);
      linearise(slopes, residual);
      Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(slopes);
      const Eigen::VectorXd move = solver.solve(-residual);
      x_ += move;
      if (move.lpNorm<Eigen::Infinity>() < 1e-9) return;
    }
    throw Error(ExitCode::usage,
                fmt::format("cavity: no steady flow found at Re = {:g}; take a smaller reynolds", reynolds_));
  }

  using Entries = std::vector<Eigen::Triplet<double>>;

  bool is_inner(int i, int j) const { return i > 0 && j > 0 && i < cells_ && j < cells_; }
  int node(int i, int j) const { return (j - 1) * (cells_ - 1) + i - 1; }
  double psi(int i, int j) const { return is_inner(i, j) ? x_[node(i, j)] : 0; }

  /// ω at the wall node (i, j) from the two nodes before it (Jensen): (−8ψ₁ + ψ₂)/(2h²), and −3/h at the lid.
  void at_wall(int i, int j, double weight, int row, Entries& entries, double& value) const {
    const int di = i == 0 ? 1 : i == cells_ ? -1 : 0, dj = j == 0 ? 1 : j == cells_ ? -1 : 0;
    const double one = -4 / (h_ * h_), two = 0.5 / (h_ * h_);
    entries.emplace_back(row, node(i + di, j + dj), weight * one);
    entries.emplace_back(row, node(i + 2 * di, j + 2 * dj), weight * two);
    value = one * psi(i + di, j + dj) + two * psi(i + 2 * di, j + 2 * dj) - (j == cells_ ? 3 / h_ : 0);
  }

  /// ω at a node, its slope into `row`.
  double omega(int i, int j, double weight, int row, Entries& entries) const {
    double value = 0;
    if (is_inner(i, j)) {
      entries.emplace_back(row, inner_ + node(i, j), weight);
      value = x_[inner_ + node(i, j)];
    } else {
      at_wall(i, j, weight, row, entries, value);
    }
    return value;
  }
  double psi(int i, int j, double weight, int row, Entries& entries) const {
    if (is_inner(i, j)) entries.emplace_back(row, node(i, j), weight);
    return psi(i, j);
  }

  void linearise(Eigen::SparseMatrix<double>& slopes, Eigen::VectorXd& residual) const {
    Entries entries;
    const double second = 1 / (h_ * h_), first = 1 / (2 * h_), nu = 1 / reynolds_;
    for (int j = 1; j < cells_; ++j)
      for (int i = 1; i < cells_; ++i) {
        const int stream = node(i, j), transport = inner_ + stream;
        residual[stream] = omega(i, j, 1, stream, entries) - 4 * second * psi(i, j, -4 * second, stream, entries);
        for (const auto& [a, b] : {std::pair{i + 1, j}, {i - 1, j}, {i, j + 1}, {i, j - 1}})
          residual[stream] += second * psi(a, b, second, stream, entries);

        const double u = first * (psi(i, j + 1) - psi(i, j - 1)), v = -first * (psi(i + 1, j) - psi(i - 1, j));
        const double east = nu * second - u * first, west = nu * second + u * first;
        const double north = nu * second - v * first, south = nu * second + v * first;
        const double e = omega(i + 1, j, east, transport, entries), w = omega(i - 1, j, west, transport, entries);
        const double n = omega(i, j + 1, north, transport, entries), s = omega(i, j - 1, south, transport, entries);
        const double here = omega(i, j, -4 * nu * second, transport, entries);
        residual[transport] = east * e + west * w + north * n + south * s - 4 * nu * second * here;
        const double along_x = first * (e - w), along_y = first * (n - s);  // of ω
        psi(i, j + 1, -first * along_x, transport, entries), psi(i, j - 1, first * along_x, transport, entries);
        psi(i + 1, j, first * along_y, transport, entries), psi(i - 1, j, -first * along_y, transport, entries);
      }
    slopes.setFromTriplets(entries.begin(), entries.end());
  }

  double reynolds_ = 0;
  int cells_;
  double h_;
  int inner_;
  Eigen::VectorXd x_;  // ψ, then ω, of the inner nodes
};

}  // namespace

CentreLines cavity_flow(double reynolds, int cells) {
  Cavity coarse(cells), fine(2 * cells);
  coarse.solve(reynolds), fine.solve(reynolds);
  CentreLines lines;
  for (int k = 0; k <= cells; ++k) {
    const double s = static_cast<double>(k) / cells;
    lines.u.add(s, (4 * fine.u(2 * k) - coarse.u(k)) / 3);
    lines.v.add(s, (4 * fine.v(2 * k) - coarse.v(k)) / 3);
  }
  return lines;
}

}  // namespace molten::study
