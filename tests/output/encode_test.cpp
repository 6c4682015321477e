#include "output/encode.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <numeric>

#include "base/sha256.hpp"

using namespace ejecta::output;

TEST(Sha256, KnownDigestsOfFips180) {
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_hex(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnThePieces) {
  const std::string text(1000, 'x');
  Sha256 pieces;
  for (std::size_t n = 0; n < text.size(); n += 37)
    pieces.update(text.data() + n, std::min<std::size_t>(37, text.size() - n));
  Sha256 whole;
  whole.update(text.data(), text.size());
  EXPECT_EQ(pieces.digest(), whole.digest());
}

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
