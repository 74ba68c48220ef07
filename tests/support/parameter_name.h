// Names of tests from names of scenes.
#pragma once

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace lockstone::test {

/// The parameter itself; googletest takes no hyphen in names.
inline std::string parameter_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

}  // namespace lockstone::test
