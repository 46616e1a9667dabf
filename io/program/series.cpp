#include "io/program/series.h"

#include <fmt/format.h>

#include <cstdlib>
#include <vector>

#include "core/error.h"
#include "io/program/say.h"

namespace molten {

namespace {

bool bounds_energy(const Features& f) { return f.integrator == IntegratorKind::energy_bounded_euler; }

std::string header_of(const Features& f, std::size_t bodies) {
  std::string header =
      "time_s,step,dt_s,limit,particles,kinetic_energy_J,potential_energy_J,heat_kgK,momentum_x_kgm/s,momentum_y_kgm/s,"
      "momentum_z_kgm/s,lower_x_m,lower_y_m,lower_z_m,upper_x_m,upper_y_m,upper_z_m,max_speed_m/s,max_compression";
  if (f.internal_energy) header += ",internal_energy_J";
  if (bounds_energy(f)) header += ",least_energy_share,mean_energy_share,largest_energy_share";
  if (f.sleep) header += ",asleep,energy_taken_by_sleep_J";
  for (std::size_t k = 0; k < bodies; ++k) header += fmt::format(",body{0}_x_m,body{0}_y_m,body{0}_z_m", k);
  return header;
}

/// Whole rows only: the last one of a file that was cut has no end of line.
std::vector<std::string> first_rows(const std::filesystem::path& file, const Series::Kept& kept) {
  const auto step_of = [](const std::string& row) { return std::atoll(row.c_str() + row.find(',') + 1); };
  std::vector<std::string> rows;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::ssize(rows) < kept.rows && std::getline(in, line) && !in.eof() && step_of(line) <= kept.step)
    rows.push_back(line);
  return rows;
}

}  // namespace

Series::Series(const std::filesystem::path& file, const Kept& kept, const Features& features, std::size_t bodies)
    : file_(file), features_(features) {
  const std::vector<std::string> rows = first_rows(file, kept);
  rows_ = std::ssize(rows);
  if (rows_ < kept.rows)
    say("warning: {}: {} of the {} rows so far are not there; going on without them\n", file.string(),
        kept.rows - rows_, kept.rows);
  const std::filesystem::path part = file.string() + ".tmp";
  {
    std::ofstream fresh(part, std::ios::trunc);
    fresh << header_of(features, bodies) << '\n';
    for (const std::string& row : rows) fresh << row << '\n';
    if (!fresh.flush())
      throw Error(ExitCode::files, file.string() + ": cannot write; check the disk and the folder's rights");
  }
  std::filesystem::rename(part, file);
  out_.open(file, std::ios::app);
}

void Series::add(const Clock& c, const Diagnostics& d) {
  out_ << fmt::format(
      "{:.9g},{},{:.6g},{},{},{:.9g},{:.9g},{:.12g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},"
      "{:.6g},{:.6g},{:.6g}",
      c.time, c.step, c.dt, name_of(c.limit), d.particles, d.kinetic_energy, d.potential_energy, d.heat, d.momentum[0],
      d.momentum[1], d.momentum[2], d.lower[0], d.lower[1], d.lower[2], d.upper[0], d.upper[1], d.upper[2], d.max_speed,
      d.max_compression);
  if (features_.internal_energy) out_ << fmt::format(",{:.9g}", d.internal_energy);
  if (bounds_energy(features_))
    out_ << fmt::format(",{:.6g},{:.6g},{:.6g}", d.least_energy_share, d.mean_energy_share, d.largest_energy_share);
  if (features_.sleep) out_ << fmt::format(",{},{:.9g}", d.asleep, d.energy_taken_by_sleep);
  for (const auto& x : d.bodies) out_ << fmt::format(",{:.9g},{:.9g},{:.9g}", x[0], x[1], x[2]);
  out_ << '\n';
  if (!out_.flush()) throw Error(ExitCode::files, file_.string() + ": cannot write; check the disk");
  ++rows_;
}

}  // namespace molten
