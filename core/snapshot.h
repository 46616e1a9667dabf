// What leaves the solver for a frame: plain double columns in id order, with names and units. Writers of files and
// pictures know only this, never the solver's storage.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace molten {

struct SnapshotField {
  std::string name, unit, meaning;  // as in fields.h
  int components = 1;               // 1 scalar; 3 vector (2-D: z = 0)
  std::vector<double> values;       // components × count, particle by particle
};

/// Where a body that moves is: x = centre + turn · (x in its own frame).
struct SnapshotBody {
  std::array<double, 3> centre{};                         // m
  std::array<double, 9> turn{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
};

struct Snapshot {
  double time = 0;  // s
  std::int64_t step = 0;
  int dimensions = 3;
  double spacing = 0;            // m; initial distance between particles
  std::vector<std::int64_t> id;  // ascending
  std::vector<double> position;  // m; 3 × count (2-D: z = 0)
  std::vector<SnapshotField> fields;
  std::vector<SnapshotBody> bodies;

  std::size_t count() const { return id.size(); }
};

}  // namespace molten
