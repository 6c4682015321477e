#include "case/case_text.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "base/error.hpp"
#include "case/problem.hpp"

namespace ejecta {
namespace {

constexpr std::size_t kMaxFileSize = 1u << 20;

/// The first byte from `n` on that is no part of a sign in UTF-8; the size of the text if there is none.
std::size_t first_not_utf8(std::string_view text, std::size_t n = 0) {
  const auto byte = [&](std::size_t n) { return n < text.size() ? static_cast<unsigned char>(text[n]) : 0u; };
  while (n < text.size()) {
    const unsigned first = byte(n);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xc2 ? 0
                               : first < 0xe0 ? 2
                               : first < 0xf0 ? 3
                               : first < 0xf5 ? 4
                                              : 0;
    if (length == 0) return n;
    for (std::size_t k = 1; k < length; ++k)
      if ((byte(n + k) & 0xc0) != 0x80) return n;
    n += length;
  }
  return text.size();
}

}  // namespace

std::string read_case_text(const std::string& path) {
  std::error_code ignored;
  const std::filesystem::path file(path);
  if (!std::filesystem::exists(file, ignored))
    throw InputError(fmt::format("{}: no such file\n  a first case:  ejecta new > my-case.toml", path));
  if (std::filesystem::is_directory(file, ignored))
    throw InputError(fmt::format("{}: is a directory; a case is a .toml file", path));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(fmt::format("{}: cannot be read (permissions?)", path));
  std::string text(kMaxFileSize + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) throw InputError(fmt::format("{}: reading failed", path));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

void check_text(const std::string& text, const std::string& name) {
  if (text.size() > kMaxFileSize)
    throw InputError(
        fmt::format("{}: larger than {} MiB; a case is a short text (surfaces belong in an STL file)", name,
                    kMaxFileSize >> 20));
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw InputError(fmt::format("{}: is empty\n  a first case:  ejecta new > my-case.toml", name));
  for (char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (u == 0 || (u < 0x20 && c != '\t' && c != '\n' && c != '\r'))
      throw InputError(fmt::format("{}: is not a text file (byte {:#04x}); a case is TOML", name, u));
  }
  if (const std::size_t at = first_not_utf8(text); at < text.size()) {
    std::string shown = text;
    for (std::size_t n = at; n < shown.size(); n = first_not_utf8(shown, n)) shown[n] = '?';
    const Problem p{
        .what = fmt::format("the byte {:#04x} is no UTF-8: the file was saved in another encoding, such as "
                            "ANSI (Windows-1252)",
                            static_cast<unsigned char>(text[at])),
        .expected = "a file saved as UTF-8, as editors offer under \"Save as\"",
        .example = "title = \"Gr\u00f6\u00dfe\"",
        .place = {std::make_shared<Source>(Source{name, shown}), at, 1}};
    throw CaseError({p});
  }
}

}  // namespace ejecta
