#include "io/hdf5/hdf5_driver.h"

#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <type_traits>

namespace molten {
namespace {

struct CarefulFile {
  H5FD_t base;  // HDF5's own part comes first
  int descriptor;
  haddr_t allocated, end;  // HDF5's "eoa" and "eof", bytes
  int* first_error;

  void note(int error) {
    if (*first_error == 0) *first_error = error;
  }
};
static_assert(std::is_standard_layout_v<CarefulFile>);

struct DriverInfo {
  int* first_error;
};

CarefulFile& careful(H5FD_t* file) { return *reinterpret_cast<CarefulFile*>(file); }
const CarefulFile& careful(const H5FD_t* file) { return *reinterpret_cast<const CarefulFile*>(file); }

// EINTR is no failure: the program installs signal handlers.
ssize_t write_some(int descriptor, const char* data, std::size_t size, haddr_t at) {
  ssize_t done = 0;
  do done = ::pwrite(descriptor, data, size, static_cast<off_t>(at));
  while (done < 0 && errno == EINTR);
  return done;
}

ssize_t read_some(int descriptor, char* data, std::size_t size, haddr_t at) {
  ssize_t done = 0;
  do done = ::pread(descriptor, data, size, static_cast<off_t>(at));
  while (done < 0 && errno == EINTR);
  return done;
}

H5FD_t* open_file(const char* name, unsigned flags, hid_t access_list, haddr_t) {
  const auto* info = static_cast<const DriverInfo*>(H5Pget_driver_info(access_list));
  if (!info) return nullptr;
  const int mode = (flags & H5F_ACC_RDWR ? O_RDWR : O_RDONLY) | (flags & H5F_ACC_TRUNC ? O_TRUNC : 0) |
                   (flags & H5F_ACC_CREAT ? O_CREAT : 0) | (flags & H5F_ACC_EXCL ? O_EXCL : 0) | O_CLOEXEC;
  const int descriptor = ::open(name, mode, 0666);
  struct stat status {};
  // HDF5 first tries whether the file is there: only the last attempt counts.
  *info->first_error = descriptor < 0 || ::fstat(descriptor, &status) != 0 ? errno : 0;
  if (descriptor < 0) return nullptr;
  auto* file = new CarefulFile{{}, descriptor, 0, static_cast<haddr_t>(status.st_size), info->first_error};
  return &file->base;
}

herr_t close_file(H5FD_t* base) {
  CarefulFile& file = careful(base);
  if (::close(file.descriptor) != 0) file.note(errno);
  delete &file;
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t allocated_end(const H5FD_t* file, H5FD_mem_t) { return careful(file).allocated; }
haddr_t file_end(const H5FD_t* file, H5FD_mem_t) { return careful(file).end; }

herr_t set_allocated_end(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  careful(file).allocated = end;
  return 0;
}

herr_t read(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* buffer) {
  char* data = static_cast<char*>(buffer);
  while (size > 0) {
    const ssize_t done = read_some(careful(base).descriptor, data, size, at);
    if (done < 0) return -1;
    if (done == 0) break;
    data += done, at += static_cast<haddr_t>(done), size -= static_cast<std::size_t>(done);
  }
  std::memset(data, 0, size);  // behind the end, as HDF5 expects
  return 0;
}

herr_t write(H5FD_t* base, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* buffer) {
  CarefulFile& file = careful(base);
  file.end = std::max(file.end, at + size);
  const char* data = static_cast<const char*>(buffer);
  while (size > 0 && *file.first_error == 0) {
    const ssize_t done = write_some(file.descriptor, data, size, at);
    if (done < 0) file.note(errno);
    if (done == 0) file.note(EIO);
    if (done <= 0) break;
    data += done, at += static_cast<haddr_t>(done), size -= static_cast<std::size_t>(done);
  }
  return 0;
}

herr_t truncate(H5FD_t* base, hid_t, hbool_t) {
  CarefulFile& file = careful(base);
  if (file.end == file.allocated) return 0;
  if (*file.first_error == 0 && ::ftruncate(file.descriptor, static_cast<off_t>(file.allocated)) != 0) file.note(errno);
  file.end = file.allocated;
  return 0;
}

hid_t register_driver() {
  static H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION  // HDF5 1.14 on
  driver.version = H5FD_CLASS_VERSION;
  driver.value = H5FD_RESERVED + 40;
#endif
  driver.name = "molten";
  driver.maxaddr = static_cast<haddr_t>(INT64_MAX);
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(DriverInfo);
  driver.open = open_file;
  driver.close = close_file;
  driver.query = query;
  driver.get_eoa = allocated_end;
  driver.set_eoa = set_allocated_end;
  driver.get_eof = file_end;
  driver.read = read;
  driver.write = write;
  driver.truncate = truncate;
  constexpr H5FD_mem_t kinds[] = H5FD_FLMAP_DICHOTOMY;  // metadata and raw data apart
  std::copy(std::begin(kinds), std::end(kinds), driver.fl_map);
  return H5FDregister(&driver);
}

}  // namespace

bool use_careful_driver(std::int64_t access_list, int* first_error) {
  static const hid_t driver = register_driver();
  const DriverInfo info{first_error};
  return driver >= 0 && H5Pset_driver(access_list, driver, &info) >= 0;
}

}  // namespace molten
