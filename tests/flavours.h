// The {dimensions} × {precision} that typed tests run over.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace molten {

template <int dim_, class Real_> struct Flavour {
  static constexpr int dim = dim_;
  using Real = Real_;
  static constexpr bool single = sizeof(Real) == 4;
};
using Flavours = testing::Types<Flavour<2, float>, Flavour<2, double>, Flavour<3, float>, Flavour<3, double>>;

struct FlavourNames {
  template <class F> static std::string GetName(int) {
    return std::to_string(F::dim) + (F::single ? "dSingle" : "dDouble");
  }
};

/// First line of a test over them: what its body calls the two.
#define MOLTEN_FLAVOUR                \
  constexpr int Dim = TypeParam::dim; \
  using Real [[maybe_unused]] = typename TypeParam::Real

}  // namespace molten
