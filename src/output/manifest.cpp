#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "base/real.hpp"
#include "base/sha256.hpp"
#include "output/build_info.hpp"
#include "output/run_directory.hpp"

namespace ejecta::output {
namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
  return "unknown";
}

std::int64_t memory_bytes() {
  return std::int64_t(::sysconf(_SC_PHYS_PAGES)) * std::int64_t(::sysconf(_SC_PAGESIZE));
}

}  // namespace

nlohmann::ordered_json digests_of(const std::vector<std::string>& files) {
  auto all = nlohmann::ordered_json::object();
  for (const std::string& file : files) {
    std::ostringstream text;
    std::ifstream in(file, std::ios::binary);
    text << in.rdbuf();
    all[file] = in ? sha256_hex(text.str()) : "";
  }
  return all;
}

nlohmann::ordered_json make_manifest(const Provenance& p) {
  utsname system{};
  ::uname(&system);
  return {{"program", "ejecta"},
          {"version", version()},
          {"git_revision", git_revision()},
          {"compiler", compiler()},
          {"compile_flags", compile_flags()},
          {"kernels", kernels()},
          {"precision", kPrecision},
          {"command", p.command},
          {"case", p.case_path},
          {"set", p.overrides},
          {"input_sha256", sha256_hex(p.input)},
          {"files", digests_of(p.files)},
          {"started", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()))},
          {"threads", p.threads},
          {"machine",
           {{"host", system.nodename},
            {"system", fmt::format("{} {}", system.sysname, system.release)},
            {"processor", processor()},
            {"logical_processors", std::thread::hardware_concurrency()},
            {"memory_bytes", memory_bytes()}}}};
}

std::vector<std::string> provenance_lines(const Provenance& p) {
  std::vector<std::string> lines{fmt::format("ejecta {} ({}, {})", version(), git_revision(), kPrecision),
                                 fmt::format("case {}", p.case_path)};
  for (const std::string& set : p.overrides) lines.push_back("set " + set);
  lines.push_back(fmt::format("input sha256 {}", sha256_hex(p.input)));
  return lines;
}

}  // namespace ejecta::output
