#include "io/picture/render.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "io/picture/camera.h"
#include "io/picture/colour_field.h"
#include "io/picture/font.h"
#include "tests/temp_folder.h"

namespace molten::render_test {
namespace {

struct Pixel {
  int r, g, b;
};

Pixel at(const Picture& picture, int x, int y) {
  const unsigned char* p = &picture.rgb[3 * (static_cast<std::size_t>(y) * picture.width + x)];
  return {p[0], p[1], p[2]};
}

double difference(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(a.rgb[i] - b.rgb[i]);
  return sum / static_cast<double>(a.rgb.size());
}

Snapshot particles(const std::vector<Vec3>& positions, double spacing = 0.1) {
  Snapshot snapshot;
  snapshot.spacing = spacing;
  for (const Vec3& position : positions) {
    snapshot.id.push_back(static_cast<std::int64_t>(snapshot.id.size()));
    for (int axis = 0; axis < 3; ++axis) snapshot.position.push_back(position[axis]);
  }
  return snapshot;
}

Snapshot with_field(Snapshot snapshot, const std::string& name, const std::vector<double>& values, int components = 1) {
  snapshot.fields.push_back({name, "°C", "", components, values});
  return snapshot;
}

PictureOptions small() {
  PictureOptions options;
  options.width = 160;
  options.height = 120;
  return options;
}

TriangleMesh floor_at(double z, double half_size) {
  const double s = half_size;
  return {{{-s, -s, z}, {s, -s, z}, {s, s, z}, {-s, s, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

TEST(Render, OneSphereInTheMiddle) {
  const Picture picture = draw(particles({{5, -3, 2}}), {}, small());
  ASSERT_EQ(picture.rgb.size(), 3u * 160 * 120);
  const Pixel middle = at(picture, 80, 60), corner = at(picture, 2, 117);
  EXPECT_GT(middle.b, middle.r + 30);  // the plain blue
  for (const int channel : {corner.r, corner.g, corner.b}) EXPECT_GT(channel, 225);
}

TEST(Render, HotAndColdHaveTheColoursOfTheirTemperature) {
  PictureOptions options = small();
  options.range = {0, 100};
  options.eye = {0, -1, 0};
  options.look_at = {0, 0, 0};
  const auto middle = [&](double temperature) {
    const Picture picture = draw(with_field(particles({{0, 0, 0}}), "temperature", {temperature}), {}, options);
    return at(picture, 80 - 80 * 13 / 100, 60);  // left of the middle: the legend needs room
  };
  const Pixel cold = middle(0), red = middle(60), hot = middle(100), broken = middle(std::nan(""));
  EXPECT_LT(cold.r + cold.g + cold.b, 300);
  EXPECT_GT(red.r, red.b + 60);
  EXPECT_GT(red.r, red.g + 60);
  EXPECT_GT(hot.r, 180);
  EXPECT_GT(hot.g, 150);
  EXPECT_GT(broken.b, broken.g + 60);  // not on the map
  EXPECT_GT(broken.r, broken.g + 60);
}

TEST(Render, FarFromTheOriginLooksTheSame) {
  const Vec3 far(5e6, -3e6, 1e4);
  std::vector<Vec3> near_points, far_points;
  for (int i = 0; i < 200; ++i) near_points.emplace_back(0.1 * (i % 6), 0.1 * (i / 6 % 6), 0.1 * (i / 36));
  for (const Vec3& point : near_points) far_points.push_back(point + far);
  TriangleMesh near_floor = floor_at(-0.05, 50), far_floor = near_floor;
  for (Vec3& vertex : far_floor.vertices) vertex += far;
  EXPECT_LT(
      difference(draw(particles(near_points), near_floor, small()), draw(particles(far_points), far_floor, small())),
      0.5);
}

TEST(Render, RepeatsBitForBit) {
  const Snapshot snapshot = particles({{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0.1}});
  EXPECT_EQ(draw(snapshot, floor_at(-0.05, 1), small()).rgb, draw(snapshot, floor_at(-0.05, 1), small()).rgb);
}

TEST(Render, FixedViewFitsLikeTheFreeOne) {
  for (const int dimensions : {2, 3}) {
    Snapshot snapshot = with_field(particles({{0, 0, 0}, {0.3, 0.1, 0}}), "temperature", {1, 2});
    snapshot.dimensions = dimensions;
    const PictureOptions fixed = picture::with_fixed_view(small(), {&snapshot, 1}, {});
    EXPECT_LT(difference(draw(snapshot, {}, small()), draw(snapshot, {}, fixed)), 0.5);
  }
}

TEST(Render, LooksIntoATankFromOutside) {
  TriangleMesh box;
  for (int i = 0; i < 8; ++i) box.vertices.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const Pixel middle = at(draw(particles({{0, 0, 0}}, 1.0), box, small()), 80, 60);
  EXPECT_GT(middle.b, middle.r + 30);
  // An obstacle stays closed.
  TriangleMesh obstacle = box;
  for (Vec3& vertex : obstacle.vertices) vertex *= 0.3;
  const Picture hidden = draw(particles({{0, 3, 0}, {0, -3, 0}, {3, 0, 0}, {-3, 0, 0}}, 1.0), obstacle, small());
  const Pixel grey = at(hidden, 80, 60);
  EXPECT_LT(std::abs(grey.b - grey.r), 25);
}

TEST(Render, TwoDimensionalScenesAreSeenAlongZ) {
  Snapshot snapshot = particles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, 0.5);
  snapshot.dimensions = 2;
  const TriangleMesh wall{{{-1, -1, -1}, {-1, -1, 1}, {-1, 2, 1}, {-1, 2, -1}}, {{0, 1, 2}, {0, 2, 3}}};
  const Picture picture = draw(snapshot, wall, small());
  int blue = 0, grey = 0;
  for (int x = 0; x < picture.width; ++x)
    for (int y = 30; y < picture.height; ++y) {
      const Pixel p = at(picture, x, y);
      blue += p.b > p.r + 40;
      grey += p.r < 180 && std::abs(p.b - p.r) < 15;
    }
  EXPECT_GT(blue, 500);
  EXPECT_GT(grey, 50);
}

TEST(Render, EmptyAndBrokenSnapshotsDoNotCrash) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_NO_THROW(draw(Snapshot(), {}, small()));
  EXPECT_NO_THROW(draw(with_field(Snapshot(), "temperature", {}), floor_at(0, 1), small()));
  EXPECT_NO_THROW(draw(particles({{nan, 0, 0}, {infinity, 0, 0}}), {}, small()));
  const Picture picture = draw(
      with_field(particles({{0, 0, 0}, {nan, 0, 0}, {0, -infinity, 0}, {1e300, 0, 0}}), "temperature", {1, nan, 2, 3}),
      floor_at(nan, 1), small());
  EXPECT_EQ(picture.width, 160);
  Snapshot no_spacing = particles({{0, 0, 0}, {1, 0, 0}}, 0.0);
  EXPECT_NO_THROW(draw(no_spacing, {}, small()));
}

TEST(Render, UnknownFieldsAreRefusedWithTheKnownOnes) {
  PictureOptions options = small();
  options.field = "colour";
  try {
    draw(with_field(with_field(particles({{0, 0, 0}}), "temperature", {1}), "velocity", {1, 2, 3}, 3), {}, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("temperature, velocity"), std::string::npos) << error.what();
  }
}

TEST(Render, BadOptionsAreRefused) {
  const auto refused = [](auto change) {
    PictureOptions options = small();
    change(options);
    EXPECT_THROW(draw(particles({{0, 0, 0}}), {}, options), Error);
  };
  refused([](PictureOptions& o) { o.width = 0; });
  refused([](PictureOptions& o) { o.height = 1 << 20; });
  refused([](PictureOptions& o) { o.zoom = 0; });
  refused([](PictureOptions& o) { o.azimuth = std::nan(""); });
  refused([](PictureOptions& o) { o.eye = o.look_at = {1, 1, 1}; });
  refused([](PictureOptions& o) { o.range = {2, 1}; });
}

TEST(ColourField, ChoosesTemperatureThenSpeed) {
  const Snapshot moving = with_field(particles({{0, 0, 0}, {1, 0, 0}}), "velocity", {3, 4, 0, 0, 0, 1}, 3);
  EXPECT_EQ(colour_field(moving, "")->title, "speed (°C)");
  EXPECT_EQ(colour_field(moving, "velocity magnitude")->values, (std::vector<double>{5, 1}));
  EXPECT_EQ(colour_field(moving, "speed")->values, (std::vector<double>{5, 1}));
  EXPECT_EQ(colour_field(with_field(moving, "temperature", {7, 8}), "")->values, (std::vector<double>{7, 8}));
  EXPECT_FALSE(colour_field(particles({{0, 0, 0}}), ""));
}

TEST(ColourField, RangeIsThatOfTheFiniteValues) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Snapshot snapshot =
      with_field(particles(std::vector<Vec3>(4, Vec3::Zero())), "temperature", {3, std::nan(""), -2, infinity});
  EXPECT_EQ(*colour_field(snapshot, "")->range(), (std::array<double, 2>{-2, 3}));
  EXPECT_FALSE(colour_field(with_field(Snapshot(), "temperature", {}), "")->range());
}

TEST(Font, DrawsInsideItsWidth) {
  Picture picture{200, 20, std::vector<unsigned char>(200 * 20 * 3, 255)};
  const std::string text = "gT (°C) m/s² ☃";
  draw_text(picture, text, 5, 3, 1.5f, {0, 0, 0});
  int inked = 0, outside = 0;
  for (int x = 0; x < 200; ++x)
    for (int y = 0; y < 20; ++y)
      if (at(picture, x, y).r < 128) (x < 4 || x > 6 + text_width(text, 1.5f) ? outside : inked)++;
  EXPECT_GT(inked, 100);
  EXPECT_EQ(outside, 0);
}

TEST(Png, ReadsBackTheSame) {
  const TempFolder folder;
  const Picture picture = draw(particles({{0, 0, 0}}), {}, small());
  const auto file = folder.path() / "new folder" / "a b.png";
  write_png(picture, file);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&image, file.c_str()));
  EXPECT_EQ(image.width, 160u);
  image.format = PNG_FORMAT_RGB;
  std::vector<unsigned char> rgb(PNG_IMAGE_SIZE(image));
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr));
  EXPECT_EQ(rgb, picture.rgb);
}

TEST(Png, BadPlacesAreFileErrors) {
  const TempFolder folder;
  write_bytes(folder.path() / "flat", "");
  try {
    write_png(draw(Snapshot(), {}, small()), folder.path() / "flat" / "a.png");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::files);
  }
}

}  // namespace
}  // namespace molten::render_test
