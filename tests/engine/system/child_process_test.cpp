// Nacre: tests of running another program.
#include "engine/system/child_process.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

using namespace std::chrono_literals;

ChildResult shell(const std::string& script, std::chrono::milliseconds limit = 20s,
                  const std::atomic<bool>* stop = nullptr) {
  return run_child("/bin/sh", {"-c", script}, limit, stop);
}

TEST(ChildProcess, OutputErrorsAndStatus) {
  const ChildResult result = shell("echo one; echo two >&2; exit 3");
  EXPECT_EQ(result.output, "one\n");
  EXPECT_EQ(result.errors, "two\n");
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_EQ(result.signal, 0);
  EXPECT_FALSE(result.timed_out);
}

TEST(ChildProcess, ArgumentsArePassedAsTheyAre) {
  EXPECT_EQ(run_child("/bin/echo", {"a b", "$x", ""}, 20s).output, "a b $x \n");
}

TEST(ChildProcess, MuchOutputOnBothPipesDoesNotBlock) {
  const ChildResult result = shell("head -c 3000000 /dev/zero >&2; head -c 3000000 /dev/zero");
  EXPECT_EQ(result.output.size(), 3000000u);
  EXPECT_EQ(result.errors.size(), 65536u);
  EXPECT_EQ(result.exit_status, 0);
}

TEST(ChildProcess, SignalsAreReported) {
  const ChildResult result = shell("kill -SEGV $$");
  EXPECT_EQ(result.signal, SIGSEGV);
  EXPECT_EQ(result.exit_status, -1);
}

TEST(ChildProcess, SignalsThatWeIgnoreStillStopIt) {
  const auto before = std::signal(SIGINT, SIG_IGN);
  const ChildResult result = shell("kill -INT $$; exit 0");
  std::signal(SIGINT, before);
  EXPECT_EQ(result.signal, SIGINT);
}

TEST(ChildProcess, IsKilledWhenItsTimeIsOver) {
  const auto start = std::chrono::steady_clock::now();
  const ChildResult result = run_child("/bin/sleep", {"60"}, 200ms);
  EXPECT_TRUE(result.timed_out);
  EXPECT_EQ(result.signal, SIGKILL);
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
}

TEST(ChildProcess, IsKilledOnRequest) {
  std::atomic<bool> stop{false};
  std::thread later([&] {
    std::this_thread::sleep_for(100ms);
    stop = true;
  });
  const ChildResult result = run_child("/bin/sleep", {"60"}, 60s, &stop);
  later.join();
  EXPECT_TRUE(result.stopped);
  EXPECT_FALSE(result.timed_out);
}

TEST(ChildProcess, WhatWaitsForItEndsOnRequest) {
  const std::vector<char> bytes(4 << 20);  // more than a socket holds
  for (const bool sends : {false, true}) {
    std::atomic<bool> stop{false};
    std::thread later([&] {
      std::this_thread::sleep_for(100ms);
      stop = true;
    });
    const auto start = std::chrono::steady_clock::now();
    {
      ChildProcess child("/bin/sleep", {"60"}, &stop);
      EXPECT_THROW(sends ? child.send(bytes.data(), bytes.size()) : child.wait(), Interrupted);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
    later.join();
  }
}

TEST(ChildProcess, MissingProgramIsAnError) { EXPECT_THROW(run_child("/no/such/program", {}, 1s), Error); }

}  // namespace
}  // namespace nacre
