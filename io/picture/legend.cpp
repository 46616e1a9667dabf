#include "io/picture/legend.h"

#include <fmt/format.h>

#include <cmath>

#include "io/picture/font.h"

namespace molten {
namespace {

constexpr Rgb ink{0.13f, 0.14f, 0.16f};
constexpr int ticks = 5;  // lowest and highest included

float text_size(const Picture& picture) { return std::max(0.7f, static_cast<float>(picture.height) / 380); }

// A hair above or below zero, beside large numbers, is zero.
std::string number_text(double value, double span) {
  if (std::abs(value) < 1e-9 * span) value = 0;
  return fmt::format("{:.4g}", value);
}

struct Bar {
  int left, top, width, height;
};

void draw_bar(Picture& picture, const Bar& bar, ColourMap map) {
  for (int y = -1; y <= bar.height; ++y)
    for (int x = -1; x <= bar.width; ++x) {
      const bool border = x < 0 || y < 0 || x == bar.width || y == bar.height;
      const double t = 1 - (y + 0.5) / bar.height;
      blend(picture, bar.left + x, bar.top + y, border ? ink : colour(map, t), 1);
    }
}

void draw_tick(Picture& picture, const Bar& bar, float size, double share, const std::string& text) {
  const int y = bar.top + static_cast<int>(std::lround((1 - share) * (bar.height - 1)));
  const int length = static_cast<int>(2 * size);
  for (int x = 1; x <= length; ++x) blend(picture, bar.left - 1 - x, y, ink, 1);
  const float right = static_cast<float>(bar.left) - static_cast<float>(length) - 3 * size;
  draw_text(picture, text, right - text_width(text, size), y + 0.5f - text_height(size) / 2, size, ink);
}

}  // namespace

void draw_legend(Picture& picture, const std::string& title, ColourMap map, const std::array<double, 2>& range) {
  const float size = text_size(picture), margin = 9 * size;
  // A long title on a narrow picture is written smaller.
  const float room = static_cast<float>(picture.width) - 2 * margin;
  const float title_size = std::min(size, size * room / std::max(text_width(title, size), 1.0f));
  draw_text(picture, title, static_cast<float>(picture.width) - margin - text_width(title, title_size), margin,
            title_size, ink);
  const int width = static_cast<int>(9 * size);
  const Bar bar{picture.width - static_cast<int>(margin) - width, static_cast<int>(margin + 16 * size), width,
                picture.height * 2 / 5};
  draw_bar(picture, bar, map);
  for (int i = 0; i < ticks; ++i) {
    const double share = static_cast<double>(i) / (ticks - 1), span = range[1] - range[0];
    draw_tick(picture, bar, size, share, number_text(range[0] + share * span, span));
  }
}

void draw_time(Picture& picture, double time) {
  const float size = text_size(picture), margin = 9 * size;
  const std::string text =
      std::abs(time) < 1000 ? fmt::format("t = {:.3f} s", time) : fmt::format("t = {:.6g} s", time);
  draw_text(picture, text, margin, margin, size, ink);
}

}  // namespace molten
