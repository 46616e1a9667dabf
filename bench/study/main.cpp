// The study's program: runs one case and prints what it judges as CSV.
//   study --case NAME [--size N] [--numerics PRESET] [--set key=value]...    threads by OMP_NUM_THREADS
//   study --list     every case with its size and parameters, as Markdown
// Exit codes: 0 judged; 2 usage; 4 the run diverged (its errors are nan); others as the program's own.
#include <fmt/format.h>

#include "bench/study/request.h"
#include "core/error.h"

namespace {

using molten::Error;
using molten::ExitCode;
using namespace molten::study;

constexpr const char* usage = "study --case NAME [--size N] [--numerics PRESET] [--set key=value]... | --list | --help";

struct Words {
  std::string name, size, numerics;
  std::vector<std::string> settings;
  bool list = false, help = false;
};

/// The value of option k: what follows its =, else the next word.
std::string value_of(const std::vector<std::string>& words, std::size_t& k) {
  const std::size_t equals = words[k].find('=');
  if (equals != std::string::npos) return words[k].substr(equals + 1);
  if (k + 1 == words.size()) throw Error(ExitCode::usage, words[k] + ": wants a value; usage: " + usage);
  return words[++k];
}

Words read_words(const std::vector<std::string>& words) {
  Words w;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string option = words[k].substr(0, words[k].find('='));
    if (option == "--case")
      w.name = value_of(words, k);
    else if (option == "--size")
      w.size = value_of(words, k);
    else if (option == "--numerics")
      w.numerics = value_of(words, k);
    else if (option == "--set")
      w.settings.push_back(value_of(words, k));
    else if (option == "--list")
      w.list = true;
    else if (option == "--help" || option == "-h")
      w.help = true;
    else
      throw Error(ExitCode::usage, words[k] + ": unknown option; usage: " + usage);
  }
  return w;
}

ExitCode run(const Words& w) {
  if (w.help || w.list) {
    fmt::print("{}\n", w.help ? usage : cases_page());
    return ExitCode::done;
  }
  if (w.name.empty()) throw Error(ExitCode::usage, std::string("no --case; usage: ") + usage);
  const Case& chosen = find_case(w.name);
  const Request request = make_request(chosen, w.size, w.numerics, w.settings);
  Report report;
  const bool stayed = run_case(chosen, request, report);
  fmt::print("{}{}", csv_header(), csv_lines(chosen, request, report));
  return stayed ? ExitCode::done : ExitCode::diverged;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return static_cast<int>(run(read_words({argv + 1, argv + argc})));
  } catch (const Error& e) {
    fmt::print(stderr, "study: {}\n", e.what());
    return static_cast<int>(e.code());
  } catch (const std::exception& e) {
    fmt::print(stderr, "study: {}\n", e.what());
    return 1;
  }
}
