// SPDX-License-Identifier: GPL-3.0-or-later
// A folder for the files of the running test alone: ctest runs the tests side by side.
#pragma once

#include <filesystem>
#include <gtest/gtest.h>
#include <string>

/// build/.../scratch/Suite.Test, made if it is not there; keeps what the last run left.
inline std::filesystem::path own_scratch() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    const auto folder = std::filesystem::path(LODESTONE_TEST_SCRATCH) /
                        (std::string(test.test_suite_name()) + "." + test.name());
    std::filesystem::create_directories(folder);
    return folder;
}

/// A folder in it that is not there.
inline std::filesystem::path scratch(const std::string& name) {
    std::filesystem::path folder = own_scratch() / name;
    std::filesystem::remove_all(folder);
    return folder;
}
