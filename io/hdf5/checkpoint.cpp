#include "io/hdf5/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "core/error.h"
#include "io/hdf5/atomic_file.h"
#include "io/hdf5/hdf5.h"
#include "io/hdf5/seal.h"

namespace molten {
namespace {

namespace fs = std::filesystem;
constexpr const char* kind = "checkpoint";
constexpr int format_version = 5;  // raise it when what is archived changes

fs::path folder_of(const fs::path& run_folder) { return run_folder / "checkpoints"; }

std::optional<std::int64_t> step_of(const fs::path& file) {
  const std::string stem = file.stem().string(), prefix = "step-";
  if (file.extension() != ".h5" || !stem.starts_with(prefix)) return std::nullopt;
  std::int64_t step = 0;
  const auto [end, error] = std::from_chars(stem.data() + prefix.size(), stem.data() + stem.size(), step);
  return error == std::errc() && end == stem.data() + stem.size() ? std::optional(step) : std::nullopt;
}

std::string state_name(std::string_view name) { return "state/" + std::string(name); }

class Writer : public Archive {
 public:
  explicit Writer(Hdf5File& file) : file_(file) {}
  bool loading() const override { return false; }
  void value(std::string_view name, double& v) override { file_.write(state_name(name), {}, NumberType::f64, &v); }
  void value(std::string_view name, std::int64_t& v) override {
    file_.write(state_name(name), {NumberType::i64, {}}, NumberType::i64, &v);
  }
  void array(std::string_view name, NumberType type, void* data, std::size_t count) override {
    file_.write(state_name(name), {type, {count}}, type, data);
  }
  std::size_t stored_count(std::string_view name) const override {
    throw std::logic_error("stored_count of '" + std::string(name) + "' while saving");
  }

 private:
  Hdf5File& file_;
};

class Reader : public Archive {
 public:
  explicit Reader(const Hdf5File& file) : file_(file) {}
  bool loading() const override { return true; }
  void value(std::string_view name, double& v) override { read(name, NumberType::f64, {}, &v); }
  void value(std::string_view name, std::int64_t& v) override { read(name, NumberType::i64, {}, &v); }
  void array(std::string_view name, NumberType type, void* data, std::size_t count) override {
    read(name, type, {count}, data);
  }
  std::size_t stored_count(std::string_view name) const override {
    const Hdf5Layout layout = file_.layout(state_name(name));
    if (layout.dimensions.size() != 1) file_.fail("'" + state_name(name) + "' is no array");
    return layout.dimensions[0];
  }

 private:
  void read(std::string_view name, NumberType type, const std::vector<std::uint64_t>& dimensions, void* data) const {
    const Hdf5Layout layout = file_.layout(state_name(name));
    if (layout.dimensions.size() != dimensions.size() || layout.count() != Hdf5Layout{type, dimensions}.count())
      file_.fail(fmt::format("'{}' holds {}, but this run needs {}", state_name(name), size_text(layout.dimensions),
                             size_text(dimensions)));
    if (layout.type != type) file_.fail(fmt::format("'{}' holds another type of number", state_name(name)));
    if (layout.count() > 0) file_.read(state_name(name), type, data);
  }
  static std::string size_text(const std::vector<std::uint64_t>& dimensions) {
    return dimensions.empty() ? "one number" : fmt::format("an array of {}", dimensions[0]);
  }

  const Hdf5File& file_;
};

// Texts are arrays of bytes: HDF5's attributes end at 64 kB and a scene may be longer.
void write_bytes(Hdf5File& file, const std::string& name, const std::string& text) {
  file.write(name, {NumberType::u8, {text.size()}}, NumberType::u8, text.data());
}

std::string read_bytes(const Hdf5File& file, const std::string& name) {
  std::string text(file.layout(name).count(), '\0');
  if (!text.empty()) file.read(name, NumberType::u8, text.data());
  return text;
}

void write_head(Hdf5File& file, const CheckpointHead& head) {
  file.write_attribute("/", "format_version", std::vector<std::int64_t>{format_version});
  file.write("head/step", {NumberType::i64, {}}, NumberType::i64, &head.step);
  file.write("head/time", {}, NumberType::f64, &head.time);
  write_bytes(file, "head/scene_text", head.scene_text);
  write_bytes(file, "head/scene_hash", head.scene_hash);
  write_bytes(file, "head/version", head.version);
}

Hdf5File open_whole(const fs::path& path) {
  const std::string defect = seal_defect(path, kind, format_version);
  if (!defect.empty()) throw Error(ExitCode::checkpoint, path.string() + ": " + defect);
  return Hdf5File::open(path, ExitCode::checkpoint);
}

// Files of a later step come from before a resume that went back; the run has now taken another way.
void remove_superseded(const fs::path& run_folder, std::int64_t newest_step, int keep) {
  int kept = 0;
  for (const fs::path& file : list_checkpoints(run_folder)) {
    const bool later = *step_of(file) > newest_step;
    std::error_code ignored;  // a file too many does no harm
    if (later || kept++ >= std::max(keep, 1)) fs::remove(file, ignored);
  }
}

}  // namespace

void write_checkpoint(const fs::path& run_folder, const CheckpointHead& head, const std::function<void(Archive&)>& save,
                      int keep) {
  remove_temporaries(folder_of(run_folder));
  AtomicFile place(folder_of(run_folder) / fmt::format("step-{:09}.h5", head.step));
  Hdf5File file = Hdf5File::create(place.temporary(), ExitCode::files, seal_bytes);
  write_head(file, head);
  Writer archive(file);
  save(archive);
  file.close();
  seal(place.temporary(), kind, format_version);
  place.commit();
  remove_superseded(run_folder, head.step, keep);
}

std::vector<fs::path> list_checkpoints(const fs::path& run_folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder_of(run_folder), error), end; !error && entry != end; entry.increment(error))
    if (step_of(entry->path())) files.push_back(entry->path());
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) { return *step_of(a) > *step_of(b); });
  return files;
}

CheckpointHead read_checkpoint_head(const fs::path& path) {
  const Hdf5File file = open_whole(path);
  CheckpointHead head;
  head.step = file.read_integers("head/step").at(0);
  head.time = file.read_doubles("head/time").at(0);
  head.scene_text = read_bytes(file, "head/scene_text");
  head.scene_hash = read_bytes(file, "head/scene_hash");
  head.version = read_bytes(file, "head/version");
  return head;
}

void read_checkpoint(const fs::path& path, const std::function<void(Archive&)>& load) {
  const Hdf5File file = open_whole(path);
  Reader archive(file);
  load(archive);
}

}  // namespace molten
