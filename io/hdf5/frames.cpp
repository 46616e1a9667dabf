#include "io/hdf5/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "core/error.h"
#include "io/hdf5/atomic_file.h"
#include "io/hdf5/hdf5.h"
#include "io/hdf5/seal.h"

namespace molten {
namespace {

namespace fs = std::filesystem;
constexpr const char* kind = "frame";
constexpr int format_version = 1;
constexpr const char* bodies_path = "VTKHDF/FieldData/bodies";
constexpr std::uint8_t poly_vertex = 2;  // VTK's name of a cell that is a heap of points

std::string frame_name(int number) { return fmt::format("frames/{:06}.hdf", number); }

std::optional<int> frame_number(const fs::path& file) {
  const std::string stem = file.stem().string();
  int number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  const bool digits = error == std::errc() && end == stem.data() + stem.size() && stem.size() >= 6 && number >= 0;
  return digits && file.extension() == ".hdf" ? std::optional(number) : std::nullopt;
}

// ---- one frame --------------------------------------------------------------------------------------------------

void check_sizes(const Snapshot& snapshot) {
  bool same = snapshot.position.size() == 3 * snapshot.count();
  for (const SnapshotField& field : snapshot.fields)
    same = same && field.components > 0 && field.values.size() == field.components * snapshot.count();
  if (!same) throw std::invalid_argument("a snapshot's columns differ in length");
}

void write_integers(Hdf5File& file, const std::string& name, const std::vector<std::int64_t>& numbers) {
  file.write(name, {NumberType::i64, {numbers.size()}, true}, NumberType::i64, numbers.data());
}

void describe(Hdf5File& file, const std::string& name, const std::string& unit, const std::string& meaning) {
  file.write_text(name, "unit", unit);
  file.write_text(name, "meaning", meaning);
}

void write_cells(Hdf5File& file, std::size_t points) {
  const std::int64_t count = static_cast<std::int64_t>(points), cells = points > 0 ? 1 : 0;
  std::vector<std::int64_t> connectivity(points);
  for (std::int64_t i = 0; i < count; ++i) connectivity[i] = i;
  write_integers(file, "VTKHDF/NumberOfPoints", {count});
  write_integers(file, "VTKHDF/NumberOfCells", {cells});
  write_integers(file, "VTKHDF/NumberOfConnectivityIds", {count});
  write_integers(file, "VTKHDF/Connectivity", connectivity);
  write_integers(file, "VTKHDF/Offsets", cells ? std::vector<std::int64_t>{0, count} : std::vector<std::int64_t>{0});
  file.write("VTKHDF/Types", {NumberType::u8, {static_cast<std::uint64_t>(cells)}}, NumberType::u8, &poly_vertex);
}

void write_point_data(Hdf5File& file, const Snapshot& snapshot) {
  file.make_group("VTKHDF/PointData");
  write_integers(file, "VTKHDF/PointData/id", snapshot.id);
  describe(file, "VTKHDF/PointData/id", "1", "a particle's number, the same in all frames");
  for (const SnapshotField& field : snapshot.fields) {
    const std::string name = "VTKHDF/PointData/" + field.name;
    Hdf5Layout layout{NumberType::f32, {snapshot.count()}, true};
    if (field.components > 1) layout.dimensions.push_back(field.components);
    file.write(name, layout, NumberType::f64, field.values.data());
    describe(file, name, field.unit, field.meaning);
  }
}

void write_field_data(Hdf5File& file, const Snapshot& snapshot) {
  const std::int64_t dimensions = snapshot.dimensions;
  const std::string group = "VTKHDF/FieldData/";
  file.write(group + "time", {NumberType::f64, {1}}, NumberType::f64, &snapshot.time);
  describe(file, group + "time", "s", "simulated time");
  file.write(group + "step", {NumberType::i64, {1}}, NumberType::i64, &snapshot.step);
  describe(file, group + "step", "1", "steps since the start");
  file.write(group + "spacing", {NumberType::f64, {1}}, NumberType::f64, &snapshot.spacing);
  describe(file, group + "spacing", "m", "initial distance between particles");
  file.write(group + "dimensions", {NumberType::i64, {1}}, NumberType::i64, &dimensions);
  describe(file, group + "dimensions", "1", "2 or 3");
}

/// Rows of centre and turn (row by row), a body each; none where nothing moves.
void write_bodies(Hdf5File& file, const Snapshot& snapshot) {
  if (snapshot.bodies.empty()) return;
  std::vector<double> numbers;
  for (const SnapshotBody& body : snapshot.bodies) {
    numbers.insert(numbers.end(), body.centre.begin(), body.centre.end());
    numbers.insert(numbers.end(), body.turn.begin(), body.turn.end());
  }
  file.write(bodies_path, {NumberType::f64, {snapshot.bodies.size(), 12}}, NumberType::f64, numbers.data());
  describe(file, bodies_path, "m, 1", "centre and turn of each body: x = centre + turn x', x' in bodies/N.obj");
}

std::vector<SnapshotBody> read_bodies(const Hdf5File& file) {
  std::vector<SnapshotBody> bodies;
  if (!file.has(bodies_path)) return bodies;
  const std::vector<double> numbers = file.read_doubles(bodies_path);
  if (numbers.size() % 12 != 0) file.fail(std::string("'") + bodies_path + "' has not 12 numbers a body");
  for (std::size_t k = 0; k < numbers.size(); k += 12) {
    SnapshotBody& body = bodies.emplace_back();
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(k), 3, body.centre.begin());
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(k) + 3, 9, body.turn.begin());
  }
  return bodies;
}

void write_grid(const fs::path& path, const Snapshot& snapshot) {
  Hdf5File file = Hdf5File::create(path, ExitCode::files, seal_bytes);
  file.make_group("VTKHDF");
  file.write_attribute("VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  file.write_text("VTKHDF", "Type", "UnstructuredGrid", true);
  write_cells(file, snapshot.count());
  // Double, unlike the fields: floats are no good for positions far from the origin.
  file.write("VTKHDF/Points", {NumberType::f64, {snapshot.count(), 3}, true}, NumberType::f64,
             snapshot.position.data());
  describe(file, "VTKHDF/Points", "m", "position");
  write_point_data(file, snapshot);
  write_field_data(file, snapshot);
  write_bodies(file, snapshot);
  file.close();
}

template <class T> T only(const Hdf5File& file, const std::string& name, const std::vector<T>& values) {
  if (values.size() != 1) file.fail("'" + name + "' is not one number");
  return values[0];
}

double read_double(const Hdf5File& file, const std::string& name) { return only(file, name, file.read_doubles(name)); }
std::int64_t read_integer(const Hdf5File& file, const std::string& name) {
  return only(file, name, file.read_integers(name));
}

SnapshotField read_field(const Hdf5File& file, const std::string& name, std::size_t count) {
  const std::string path = "VTKHDF/PointData/" + name;
  const auto dimensions = file.layout(path).dimensions;
  if (dimensions.empty() || dimensions.size() > 2 || dimensions[0] != count)
    file.fail("'" + path + "' has not one row for each of the " + std::to_string(count) + " particles");
  SnapshotField field;
  field.name = name;
  field.unit = file.read_text(path, "unit");
  field.meaning = file.read_text(path, "meaning");
  field.components = dimensions.size() == 2 ? static_cast<int>(dimensions[1]) : 1;
  field.values = file.read_doubles(path);
  return field;
}

// HDF5 1.10 can crash on a damaged file, so nothing is read from one whose seal is broken.
Hdf5File open_whole(const fs::path& path) {
  const std::string defect = seal_defect(path, kind, format_version);
  if (!defect.empty()) throw Error(ExitCode::files, path.string() + ": " + defect);
  return Hdf5File::open(path, ExitCode::files);
}

// ---- the series -------------------------------------------------------------------------------------------------

using Frames = std::map<int, double>;  // number → time

fs::path series_path(const fs::path& run_folder) { return run_folder / "frames.hdf.series"; }

// Empty when there is none or it can't be understood: the frames themselves know their times.
Frames read_series(const fs::path& run_folder) {
  Frames frames;
  std::ifstream in(series_path(run_folder));
  const auto json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object() || !json.contains("files") || !json["files"].is_array()) return frames;
  for (const auto& entry : json["files"]) {
    if (!entry.is_object() || !entry.contains("name") || !entry["name"].is_string()) continue;
    if (!entry.contains("time") || !entry["time"].is_number()) continue;
    if (const auto number = frame_number(entry["name"].get<std::string>())) frames[*number] = entry["time"];
  }
  return frames;
}

void write_series(const fs::path& run_folder, const Frames& frames) {
  auto files = nlohmann::ordered_json::array();
  for (const auto& [number, time] : frames) files.push_back({{"name", frame_name(number)}, {"time", time}});
  const nlohmann::ordered_json series = {{"file-series-version", "1.0"}, {"files", files}};
  write_text_atomically(series_path(run_folder), series.dump(1) + "\n");
}

std::vector<int> frames_in(const fs::path& run_folder) {
  std::vector<int> numbers;
  std::error_code error;
  for (fs::directory_iterator entry(run_folder / "frames", error), end; !error && entry != end; entry.increment(error))
    if (const auto number = frame_number(entry->path())) numbers.push_back(*number);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

double time_of(const fs::path& file) { return read_double(open_whole(file), "VTKHDF/FieldData/time"); }

// The frames in the folder, with times from the series where it has them.
Frames known_frames(const fs::path& run_folder) {
  const Frames series = read_series(run_folder);
  Frames frames;
  for (const int number : frames_in(run_folder)) {
    const auto known = series.find(number);
    frames[number] = known != series.end() ? known->second : time_of(run_folder / frame_name(number));
  }
  return frames;
}

}  // namespace

void write_frame(const fs::path& run_folder, int number, const Snapshot& snapshot) {
  check_sizes(snapshot);
  AtomicFile file(run_folder / frame_name(number));
  write_grid(file.temporary(), snapshot);
  seal(file.temporary(), kind, format_version);
  file.commit();
  Frames frames = known_frames(run_folder);
  frames[number] = snapshot.time;
  write_series(run_folder, frames);
}

std::vector<FrameEntry> list_frames(const fs::path& run_folder) {
  std::vector<FrameEntry> entries;
  for (const auto& [number, time] : known_frames(run_folder))
    entries.push_back({run_folder / frame_name(number), time});
  if (entries.empty())
    throw Error(ExitCode::files,
                (run_folder / "frames").string() + ": no frames (000000.hdf …) here; is this a run's folder?");
  return entries;
}

Snapshot read_frame(const fs::path& path) {
  const Hdf5File file = open_whole(path);
  Snapshot snapshot;
  snapshot.id = file.read_integers("VTKHDF/PointData/id");
  snapshot.position = file.read_doubles("VTKHDF/Points");
  if (snapshot.position.size() != 3 * snapshot.count()) file.fail("'VTKHDF/Points' and 'id' differ in length");
  for (const std::string& name : file.members("VTKHDF/PointData"))
    if (name != "id") snapshot.fields.push_back(read_field(file, name, snapshot.count()));
  snapshot.time = read_double(file, "VTKHDF/FieldData/time");
  snapshot.step = read_integer(file, "VTKHDF/FieldData/step");
  snapshot.spacing = read_double(file, "VTKHDF/FieldData/spacing");
  snapshot.dimensions = static_cast<int>(read_integer(file, "VTKHDF/FieldData/dimensions"));
  snapshot.bodies = read_bodies(file);
  return snapshot;
}

std::int64_t drop_frames_from(const fs::path& run_folder, int first) {
  remove_temporaries(run_folder / "frames");
  std::int64_t left = 0;
  for (const int number : frames_in(run_folder)) {
    if (number < first) {
      ++left;
      continue;
    }
    std::error_code error;
    fs::remove(run_folder / frame_name(number), error);
    if (error)
      throw Error(ExitCode::files, (run_folder / frame_name(number)).string() + ": cannot remove: " + error.message());
  }
  if (fs::exists(run_folder / "frames")) write_series(run_folder, known_frames(run_folder));
  return left;
}

}  // namespace molten
