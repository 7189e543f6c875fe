// Nacre: tests of files as memory.
#include "engine/system/mapped_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

class MappedFileTest : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream out(file_, std::ios::binary);
    for (int i = 0; i < 30000; ++i) out.put(char(value(std::size_t(i))));
  }
  void TearDown() override { std::filesystem::remove(file_); }

  static std::uint8_t value(std::size_t i) { return std::uint8_t(i * 7 + i / 251); }
  static void expect_bytes(const MappedFile& mapped, std::size_t offset, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i) ASSERT_EQ(std::uint8_t(mapped.data()[i]), value(offset + i)) << i;
  }

  std::filesystem::path file_ = std::filesystem::path(testing::TempDir()) / "mapped_file_test.bin";
};

TEST_F(MappedFileTest, BeginsAnywhere) {
  for (const std::size_t offset : {0, 1, 4095, 4096, 5000, 29999})
    expect_bytes(MappedFile(file_, offset, 30000 - offset), offset, 30000 - offset);
}

TEST_F(MappedFileTest, WhatWasLetGoComesBack) {
  const MappedFile mapped(file_, 77, 29000);
  expect_bytes(mapped, 77, 29000);
  mapped.let_go(0, 29000);
  mapped.let_go(100, 200);
  mapped.let_go(5000, 20000);
  expect_bytes(mapped, 77, 29000);
}

TEST_F(MappedFileTest, WhatDoesNotFitIntoTheAddressesIsAnErrorWithAdvice) {
  try {
    MappedFile(file_, 0, std::size_t(1) << 50);
    ADD_FAILURE() << "a petabyte was mapped";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("ulimit -v"), std::string::npos) << error.what();
  }
}

TEST_F(MappedFileTest, AMissingFileIsAnError) { EXPECT_THROW(MappedFile(file_.string() + ".not", 0, 10), Error); }

}  // namespace
}  // namespace nacre
