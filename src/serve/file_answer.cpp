#include "serve/file_answer.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <memory>

#include "base/error.hpp"

namespace ejecta {
namespace {

const char* type_of(const std::filesystem::path& file) {
  const std::string end = file.extension().string();
  if (end == ".html") return "text/html; charset=utf-8";
  if (end == ".json") return "application/json";
  if (end == ".csv") return "text/csv; charset=utf-8";
  if (end == ".toml" || end == ".log" || end == ".jsonl") return "text/plain; charset=utf-8";
  return nullptr;
}

std::uint64_t byte_of(const std::string& text, std::uint64_t size) {
  std::uint64_t byte = 0;
  const char* const end = text.data() + text.size();
  if (!text.empty()) {
    const auto [stopped, error] = std::from_chars(text.data(), end, byte);
    if (error != std::errc() || stopped != end || byte > size)
      throw InputError(fmt::format("the file has {} bytes, and no byte \"{}\"", size, text));
  }
  return byte;
}

}  // namespace

bool is_shown(const std::filesystem::path& file) {
  std::error_code none;
  return type_of(file) && std::filesystem::is_regular_file(file, none);
}

void send_file(const std::filesystem::path& file, const std::string& from, httplib::Response& response) {
  const auto in = std::make_shared<std::ifstream>(file, std::ios::binary | std::ios::ate);
  if (!*in) throw InputError(fmt::format("{} cannot be read", file.filename().string()));
  const auto size = static_cast<std::uint64_t>(in->tellg());  // what comes meanwhile is for the next call
  const std::uint64_t begin = byte_of(from, size);
  if (begin == size) return response.set_content("", type_of(file));
  response.set_content_provider(
      size - begin, type_of(file),
      [in, begin](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        std::array<char, 65536> piece;
        in->seekg(static_cast<std::streamoff>(begin + offset));
        in->read(piece.data(), static_cast<std::streamsize>(std::min(length, piece.size())));
        const std::streamsize got = in->gcount();  // none where the file was cut meanwhile
        return got > 0 && sink.write(piece.data(), static_cast<std::size_t>(got));
      });
}

}  // namespace ejecta
