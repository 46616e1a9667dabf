#include "io/hdf5/hdf5.h"

#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "io/hdf5/hdf5_driver.h"

namespace molten {
namespace {

// HDF5 can't compress in other than equal chunks; 64 Ki numbers a chunk compress well and cost little memory.
constexpr hsize_t chunk_numbers = 65536;
// No array of ours deflates below a thousandth of its size: what claims more is damaged or hostile.
constexpr std::uint64_t most_deflation = 1100;

hid_t native(NumberType type) {
  switch (type) {
    case NumberType::f32:
      return H5T_NATIVE_FLOAT;
    case NumberType::f64:
      return H5T_NATIVE_DOUBLE;
    case NumberType::i8:
      return H5T_NATIVE_INT8;
    case NumberType::u8:
      return H5T_NATIVE_UINT8;
    case NumberType::i32:
      return H5T_NATIVE_INT32;
    case NumberType::u32:
      return H5T_NATIVE_UINT32;
    case NumberType::i64:
      return H5T_NATIVE_INT64;
    case NumberType::u64:
      return H5T_NATIVE_UINT64;
  }
  return H5I_INVALID_HID;
}

Hdf5Id property_list(hid_t kind) { return {H5Pcreate(kind), H5Pclose}; }

// The error stack is printed by default, and it belongs to a thread: silence it wherever a file is made or opened.
void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

struct Reason {
  std::string text;
  int error = 0;  // errno of the innermost system call
};

herr_t note_reason(unsigned depth, const H5E_error2_t* entry, void* out) {
  auto& reason = *static_cast<Reason*>(out);
  const std::string text = entry->desc ? entry->desc : "";
  if (depth == 0) reason.text = text.substr(0, text.find(':'));
  if (const auto at = text.find("errno = "); at != std::string::npos && reason.error == 0)
    reason.error = std::atoi(text.c_str() + at + 8);
  return 0;
}

std::string error_text(int error) {
  return error == ENOSPC || error == EDQUOT ? "the disk is full; free some space there" : std::strerror(error);
}

std::string reason_of_last_failure() {
  Reason reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note_reason, &reason);
  return reason.error ? error_text(reason.error) : reason.text;
}

Hdf5Id text_type(std::size_t length, bool ascii) {
  Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(length, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8);
  return type;
}

Hdf5Id space_of(std::span<const std::uint64_t> dimensions) {
  if (dimensions.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  const std::vector<hsize_t> sizes(dimensions.begin(), dimensions.end());
  return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose};
}

Hdf5Id creation_of(const Hdf5Layout& layout) {
  Hdf5Id list = property_list(H5P_DATASET_CREATE);
  if (!layout.gzip || layout.count() == 0 || layout.dimensions.empty()) return list;
  std::vector<hsize_t> chunk(layout.dimensions.begin(), layout.dimensions.end());
  const hsize_t row = layout.count() / chunk[0];
  chunk[0] = std::min(chunk[0], std::max<hsize_t>(chunk_numbers / row, 1));
  H5Pset_chunk(list, static_cast<int>(chunk.size()), chunk.data());
  H5Pset_shuffle(list);
  H5Pset_deflate(list, 1);
  return list;
}

herr_t note_member(hid_t, const char* name, const H5L_info_t*, void* out) {
  static_cast<std::vector<std::string>*>(out)->emplace_back(name);
  return 0;
}

constexpr unsigned creation_order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;

}  // namespace

Hdf5Id& Hdf5Id::operator=(Hdf5Id&& other) noexcept {
  if (this == &other) return *this;
  close();
  id_ = std::exchange(other.id_, -1);
  close_ = other.close_;
  return *this;
}

int Hdf5Id::close() { return id_ < 0 ? 0 : close_(std::exchange(id_, -1)); }

std::uint64_t Hdf5Layout::count() const {
  std::uint64_t product = 1;
  for (const std::uint64_t size : dimensions)
    if (__builtin_mul_overflow(product, size, &product)) return UINT64_MAX;
  return product;
}

void Hdf5File::fail(const std::string& what) const { throw Error(on_error_, path_.string() + ": " + what); }

std::string Hdf5File::reason() const { return *write_error_ ? error_text(*write_error_) : reason_of_last_failure(); }

Hdf5Id Hdf5File::check(Hdf5Id id, const std::string& action) const {
  if (id < 0 || *write_error_) fail("cannot " + action + ": " + reason());
  return id;
}

void Hdf5File::check(int status, const std::string& action) const {
  if (status < 0 || *write_error_) fail("cannot " + action + ": " + reason());
}

Hdf5File Hdf5File::create(const std::filesystem::path& path, ExitCode on_error, std::uint64_t user_block) {
  silence();
  Hdf5File file(path, on_error);
  const Hdf5Id creation = property_list(H5P_FILE_CREATE);
  if (user_block) H5Pset_userblock(creation, user_block);
  const Hdf5Id access = property_list(H5P_FILE_ACCESS);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  if (!use_careful_driver(access, file.write_error_.get())) file.fail("cannot make the file: " + file.reason());
  file.id_ = file.check({H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose}, "make the file");
  return file;
}

Hdf5File Hdf5File::open(const std::filesystem::path& path, ExitCode on_error) {
  silence();
  Hdf5File file(path, on_error);
  const Hdf5Id access = property_list(H5P_FILE_ACCESS);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  file.id_ = file.check({H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose}, "open it as HDF5");
  return file;
}

void Hdf5File::close() { check(id_.close(), "write"); }

void Hdf5File::make_group(const std::string& name) {
  const Hdf5Id links = property_list(H5P_LINK_CREATE), creation = property_list(H5P_GROUP_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  H5Pset_link_creation_order(creation, creation_order);
  check({H5Gcreate2(id_, name.c_str(), links, creation, H5P_DEFAULT), H5Gclose}, "write group '" + name + "'");
}

void Hdf5File::write(const std::string& name, const Hdf5Layout& layout, NumberType in_memory, const void* data) {
  const std::string action = "write '" + name + "'";
  const Hdf5Id space = check(space_of(layout.dimensions), action);
  const Hdf5Id links = property_list(H5P_LINK_CREATE), creation = creation_of(layout);
  H5Pset_create_intermediate_group(links, 1);
  H5Pset_obj_track_times(creation, false);  // the same run writes the same bytes
  const Hdf5Id set = check(
      {H5Dcreate2(id_, name.c_str(), native(layout.type), space, links, creation, H5P_DEFAULT), H5Dclose}, action);
  if (layout.count() > 0) check(H5Dwrite(set, native(in_memory), H5S_ALL, H5S_ALL, H5P_DEFAULT, data), action);
}

void Hdf5File::write_text(const std::string& object, const char* attribute, std::string_view text, bool ascii) {
  const std::string action = std::string("write attribute '") + attribute + "' of '" + object + "'";
  const Hdf5Id type = text_type(text.size(), ascii), space = space_of({});
  const Hdf5Id made = check(
      {H5Acreate_by_name(id_, object.c_str(), attribute, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Aclose},
      action);
  std::string padded(text);
  padded.resize(std::max<std::size_t>(text.size(), 1));
  check(H5Awrite(made, type, padded.data()), action);
}

void Hdf5File::write_attribute(const std::string& object, const char* attribute,
                               std::span<const std::int64_t> numbers) {
  const std::string action = std::string("write attribute '") + attribute + "' of '" + object + "'";
  const std::uint64_t count = numbers.size();
  const Hdf5Id space = count == 1 ? space_of({}) : space_of({&count, 1});
  const Hdf5Id made = check({H5Acreate_by_name(id_, object.c_str(), attribute, H5T_NATIVE_INT64, space, H5P_DEFAULT,
                                               H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose},
                            action);
  check(H5Awrite(made, H5T_NATIVE_INT64, numbers.data()), action);
}

bool Hdf5File::has(const std::string& name) const {
  // HDF5 answers for the last part of a path only when all parts before it exist.
  for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/', at + 1))
    if (at > 0 && H5Lexists(id_, name.substr(0, at).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(id_, name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5File::members(const std::string& name) const {
  const Hdf5Id group = check({H5Gopen2(id_, name.c_str(), H5P_DEFAULT), H5Gclose}, "read group '" + name + "'");
  const Hdf5Id creation(H5Gget_create_plist(group), H5Pclose);
  unsigned order = 0;
  H5Pget_link_creation_order(creation, &order);
  const H5_index_t index = order & H5P_CRT_ORDER_INDEXED ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
  std::vector<std::string> names;
  check(H5Literate(group, index, H5_ITER_INC, nullptr, note_member, &names), "read group '" + name + "'");
  return names;
}

Hdf5Id Hdf5File::dataset(const std::string& name) const {
  if (!has(name)) fail("it has no '" + name + "'");
  return check({H5Dopen2(id_, name.c_str(), H5P_DEFAULT), H5Dclose}, "read '" + name + "'");
}

Hdf5Layout Hdf5File::layout(const std::string& name) const {
  const Hdf5Id set = dataset(name);
  const Hdf5Id space(H5Dget_space(set), H5Sclose), type(H5Dget_type(set), H5Tclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  check(rank, "read '" + name + "'");
  Hdf5Layout layout;
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
  layout.dimensions.assign(sizes.begin(), sizes.end());
  for (const auto candidate : {NumberType::f32, NumberType::f64, NumberType::i8, NumberType::u8, NumberType::i32,
                               NumberType::u32, NumberType::i64, NumberType::u64})
    if (H5Tequal(type, native(candidate)) > 0) {
      layout.type = candidate;
      return layout;
    }
  fail("'" + name + "' holds no numbers that molten knows");
}

void Hdf5File::read(const std::string& name, NumberType in_memory, void* data) const {
  const Hdf5Id set = dataset(name);
  check(H5Dread(set, native(in_memory), H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "read '" + name + "'");
}

std::string Hdf5File::read_text(const std::string& object, const char* attribute) const {
  const std::string action = std::string("read attribute '") + attribute + "' of '" + object + "'";
  const Hdf5Id text =
      check({H5Aopen_by_name(id_, object.c_str(), attribute, H5P_DEFAULT, H5P_DEFAULT), H5Aclose}, action);
  const Hdf5Id type(H5Aget_type(text), H5Tclose), space(H5Aget_space(text), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0 || H5Sget_simple_extent_npoints(space) != 1)
    fail("cannot " + action + ": it is no text of fixed length");
  std::string value(H5Tget_size(type), '\0');
  check(H5Aread(text, type, value.data()), action);
  return value.substr(0, value.find('\0'));
}

std::int64_t Hdf5File::read_attribute(const std::string& object, const char* attribute) const {
  const std::string action = std::string("read attribute '") + attribute + "' of '" + object + "'";
  const Hdf5Id made =
      check({H5Aopen_by_name(id_, object.c_str(), attribute, H5P_DEFAULT, H5P_DEFAULT), H5Aclose}, action);
  const Hdf5Id space(H5Aget_space(made), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != 1) fail("cannot " + action + ": it is not one number");
  std::int64_t value = 0;
  check(H5Aread(made, H5T_NATIVE_INT64, &value), action);
  return value;
}

std::uint64_t Hdf5File::plausible_count(const std::string& name) const {
  const std::uint64_t count = layout(name).count();
  std::error_code ignored;
  if (count / most_deflation > std::filesystem::file_size(path_, ignored))
    fail("'" + name + "' claims " + std::to_string(count) + " numbers, more than the file can hold; it is damaged");
  return count;
}

std::vector<double> Hdf5File::read_doubles(const std::string& name) const {
  std::vector<double> values(plausible_count(name));
  if (!values.empty()) read(name, NumberType::f64, values.data());
  return values;
}

std::vector<std::int64_t> Hdf5File::read_integers(const std::string& name) const {
  std::vector<std::int64_t> values(plausible_count(name));
  if (!values.empty()) read(name, NumberType::i64, values.data());
  return values;
}

}  // namespace molten
