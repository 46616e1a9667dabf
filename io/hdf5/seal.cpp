#include "io/hdf5/seal.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include "core/error.h"

namespace molten {
namespace {

// Four running sums a 64-bit word each, so that the processor works on four multiplications at once. Every step is a
// bijection of the sum and of the word: a change in one word always changes the result.
class BlockHash {
 public:
  void add(const char* data, std::size_t size) {  // every block but the last: a multiple of 32 bytes
    for (; size >= 32; data += 32, size -= 32)
      for (int lane = 0; lane < 4; ++lane) stir(sums_[lane], word(data + 8 * lane, 8));
    for (int lane = 0; size > 0; ++lane) {
      const std::size_t part = std::min<std::size_t>(size, 8);
      stir(sums_[lane], word(data, part));
      data += part;
      size -= part;
    }
  }
  std::uint64_t result() const {
    std::uint64_t all = 0;
    for (const std::uint64_t sum : sums_) stir(all, sum);
    return all;
  }

 private:
  static std::uint64_t word(const char* data, std::size_t size) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, data, size);
    return bits;
  }
  static void stir(std::uint64_t& sum, std::uint64_t word) {
    sum = std::rotl((sum ^ word) * 0x9E3779B97F4A7C15u, 29) + 0x52DCE729u;
  }
  std::array<std::uint64_t, 4> sums_{1, 2, 3, 4};
};

std::uint64_t hash_behind_seal(std::istream& in) {
  BlockHash hash;
  std::vector<char> block(1 << 20);
  in.clear();
  in.seekg(seal_bytes);
  while (in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    hash.add(block.data(), static_cast<std::size_t>(in.gcount()));
  }
  return hash.result();
}

std::string seal_start(const std::string& kind) { return "molten " + kind + ", format "; }

std::string seal_text(const std::string& kind, int format, std::uint64_t bytes, std::uint64_t hash) {
  std::string text = fmt::format("{}{}\nbytes {}\nhash {:016x}\n", seal_start(kind), format, bytes, hash);
  text.resize(seal_bytes);
  return text;
}

std::string read_text(std::istream& in) {
  std::string text(seal_bytes, '\0');
  in.read(text.data(), seal_bytes);
  return text;
}

}  // namespace

void seal(const std::filesystem::path& file, const std::string& kind, int format) {
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  const std::string text = seal_text(kind, format, bytes, hash_behind_seal(stream));
  const bool read = stream.eof();
  stream.clear();
  stream.seekp(0);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (error || !read || !stream) throw Error(ExitCode::files, file.string() + ": cannot write its checksum");
}

std::string seal_defect(const std::filesystem::path& file, const std::string& kind, int format) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::string("cannot be opened: ") + std::strerror(errno);
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  if (error) return "cannot be read: " + error.message();
  const std::string found = read_text(in), start = seal_start(kind);
  if (!found.starts_with(start)) return fmt::format("is no molten {}, or its beginning is damaged", kind);
  const std::string begin = fmt::format("{}{}\nbytes ", start, format);
  if (!found.starts_with(begin)) {
    const std::string other = found.substr(start.size(), found.find('\n') - start.size());
    return fmt::format(
        "is of format {}, and this molten reads format {}; read it with the molten that wrote it, or run the scene "
        "anew",
        other.substr(0, 20), format);
  }
  const auto stated = std::strtoull(found.c_str() + begin.size(), nullptr, 10);
  if (bytes < stated) return fmt::format("is truncated: {} of {} bytes", bytes, stated);
  if (found != seal_text(kind, format, bytes, hash_behind_seal(in))) return "is damaged: its checksum is wrong";
  return in.eof() ? "" : "cannot be read to its end";
}

}  // namespace molten
