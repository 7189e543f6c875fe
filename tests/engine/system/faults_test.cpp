// Nacre: faults on demand.
#include "engine/system/faults.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace nacre {
namespace {

TEST(Faults, AreDueWhenAskedFor) {
  setenv("NACRE_FAULTS", "always,third@3", 1);  // read at the first question of the process
  EXPECT_FALSE(fault_due("other"));
  EXPECT_TRUE(fault_due("always"));
  EXPECT_TRUE(fault_due("always"));
  EXPECT_FALSE(fault_due("third"));
  EXPECT_FALSE(fault_due("third"));
  EXPECT_TRUE(fault_due("third"));
  EXPECT_FALSE(fault_due("third"));
}

}  // namespace
}  // namespace nacre
