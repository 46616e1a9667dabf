// A thin coat over HDF5's C interface: files hold named arrays and attributes, everything closes itself, and every
// failure is one Error with the file and the reason. HDF5's own headers stay behind this one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/archive.h"
#include "core/error.h"

namespace molten {

/// An HDF5 identifier and how to close it.
class Hdf5Id {
 public:
  using Close = int (*)(std::int64_t);
  Hdf5Id() = default;
  Hdf5Id(std::int64_t id, Close close) : id_(id), close_(close) {}
  Hdf5Id(Hdf5Id&& other) noexcept { *this = std::move(other); }
  Hdf5Id& operator=(Hdf5Id&& other) noexcept;
  ~Hdf5Id() { close(); }

  operator std::int64_t() const { return id_; }
  /// Negative when HDF5 could not.
  int close();

 private:
  std::int64_t id_ = -1;
  Close close_ = nullptr;
};

/// How an array lies in the file. No dimensions: a scalar. `gzip`: shuffled and deflated at level 1, in chunks.
struct Hdf5Layout {
  NumberType type = NumberType::f64;
  std::vector<std::uint64_t> dimensions;
  bool gzip = false;

  std::uint64_t count() const;
};

/// Arrays and attributes are named by paths such as "VTKHDF/PointData/id"; groups are made as needed.
class Hdf5File {
 public:
  /// `user_block`: bytes before HDF5's own data, left for the caller (0 or a power of two from 512).
  static Hdf5File create(const std::filesystem::path& file, ExitCode on_error, std::uint64_t user_block = 0);
  static Hdf5File open(const std::filesystem::path& file, ExitCode on_error);

  /// Flushes and closes; only after this has returned is the file known to be whole.
  void close();

  void make_group(const std::string& name);  // remembers the order in which its members are made
  void write(const std::string& name, const Hdf5Layout& layout, NumberType in_memory, const void* data);
  void write_text(const std::string& object, const char* attribute, std::string_view text, bool ascii = false);
  void write_attribute(const std::string& object, const char* attribute, std::span<const std::int64_t> numbers);

  bool has(const std::string& name) const;
  /// Names of a group's members in the order in which they were made.
  std::vector<std::string> members(const std::string& group) const;
  Hdf5Layout layout(const std::string& name) const;
  void read(const std::string& name, NumberType in_memory, void* data) const;
  std::string read_text(const std::string& object, const char* attribute) const;
  std::int64_t read_attribute(const std::string& object, const char* attribute) const;  // one number

  /// The whole array, converted to doubles or integers.
  std::vector<double> read_doubles(const std::string& name) const;
  std::vector<std::int64_t> read_integers(const std::string& name) const;

  [[noreturn]] void fail(const std::string& what) const;  // adds the file's name

 private:
  Hdf5File(const std::filesystem::path& file, ExitCode on_error) : path_(file), on_error_(on_error) {}
  std::string reason() const;
  Hdf5Id check(Hdf5Id id, const std::string& action) const;
  void check(int status, const std::string& action) const;
  Hdf5Id dataset(const std::string& name) const;
  std::uint64_t plausible_count(const std::string& name) const;

  std::filesystem::path path_;
  ExitCode on_error_;
  std::unique_ptr<int> write_error_ = std::make_unique<int>(0);  // errno of the first write that failed
  Hdf5Id id_;
};

}  // namespace molten
