#include "output/encode.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <numeric>

using namespace ejecta::output;

TEST(Base64, TestVectorsOfRfc4648) {
  const auto encoded = [](const std::string& text) {
    std::string out;
    append_base64(out, text.data(), text.size());
    return out;
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Zlib, ComesBackTheSame) {
  std::vector<std::uint8_t> bytes(10000), packed, back(10000);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t(0));
  compress_zlib(bytes, packed);
  EXPECT_LT(packed.size(), 1000u);
  uLongf size = back.size();
  ASSERT_EQ(uncompress(back.data(), &size, packed.data(), packed.size()), Z_OK);
  EXPECT_EQ(back, bytes);
}
