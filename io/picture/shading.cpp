#include "io/picture/shading.h"

#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>
#include <vector>

namespace molten::picture {
namespace {

constexpr int samples = 2;  // a pixel is seen samples × samples times
constexpr int all_samples = samples * samples;
constexpr int lamp_rays = 2, sky_rays = RayScene::rays - lamp_rays;
constexpr float lamp_size = 0.12f;  // radius of the lamp over its distance
constexpr float sky_reach = 0.15f;  // view units; what is farther away does not dim the sky
constexpr float lamp_light = 0.72f, sky_light = 0.62f, ground_light = 0.30f, gloss = 0.10f;
constexpr float fade_from = 0.75f, fade_to = 3.0f;  // view units from the middle: walls fade into the background
constexpr Rgb wall_colour{0.81f, 0.815f, 0.825f};
constexpr Rgb flat_wall_colour{0.55f, 0.56f, 0.58f};  // stands out as a thin line
constexpr Rgb background_top{0.86f, 0.90f, 0.95f}, background_bottom{0.985f, 0.985f, 0.98f};

float to_linear(float srgb) { return std::pow(srgb, 2.2f); }
float to_srgb(float linear) { return std::pow(std::max(linear, 0.0f), 1 / 2.2f); }
Rgb to_linear(Rgb c) { return {to_linear(c.r), to_linear(c.g), to_linear(c.b)}; }
Rgb scaled(Rgb c, float f, float add = 0) { return {c.r * f + add, c.g * f + add, c.b * f + add}; }

// A number from 0 to 1 for each pixel, different in neighbours and the same in every run (J. Jimenez, interleaved
// gradient noise, SIGGRAPH 2014): it grains less than random numbers.
float noise(int x, int y) {
  const float inner = 0.06711056f * static_cast<float>(x) + 0.00583715f * static_cast<float>(y);
  const float outer = 52.9829189f * (inner - std::floor(inner));
  return outer - std::floor(outer);
}

// Points evenly spread over the unit disc as in a sunflower.
struct DiscPoint {
  float x, y, radius2;
};

std::vector<DiscPoint> sunflower(int count) {
  constexpr float golden = 2.3999632f;  // radians
  std::vector<DiscPoint> points;
  for (int k = 0; k < count; ++k) {
    const float radius2 = (static_cast<float>(k) + 0.5f) / static_cast<float>(count), angle = golden * k;
    points.push_back({std::sqrt(radius2) * std::cos(angle), std::sqrt(radius2) * std::sin(angle), radius2});
  }
  return points;
}

struct Frame {
  Vec3f a, b;  // with the normal, three directions at right angles
};

Frame frame_of(const Vec3f& normal) {
  const Vec3f other = std::abs(normal.x()) > 0.7f ? Vec3f(Vec3f::UnitY()) : Vec3f(Vec3f::UnitX());
  const Vec3f a = normal.cross(other).normalized();
  return {a, normal.cross(a)};
}

class Tracer {
 public:
  explicit Tracer(const Stage& stage) : stage_(stage) {
    const Camera& camera = stage.camera;
    lamp_ = (-0.55f * camera.right + 0.65f * camera.up + 0.55f * camera.toward_eye).normalized();
    lamp_frame_ = frame_of(lamp_);
    sky_up_ = camera.flat ? camera.up : Vec3f(Vec3f::UnitZ());
    for (const Rgb& colour : stage.colours) albedo_.push_back(to_linear(colour));
    wall_ = to_linear(camera.flat ? flat_wall_colour : wall_colour);
  }

  Rgb pixel(int x, int y) const {
    Rgb sum;
    const float angle = 2 * std::numbers::pi_v<float> * noise(x, y);
    const float cosine = std::cos(angle), sine = std::sin(angle);
    const Rgb behind = background(y);
    for (int s = 0; s < all_samples; ++s) {
      const float dx = (static_cast<float>(s % samples) + 0.5f) / samples;
      const float dy = (static_cast<float>(s / samples) + 0.5f) / samples;
      const Rgb seen = sample(static_cast<float>(x) + dx, static_cast<float>(y) + dy, {s, cosine, sine}, behind);
      sum = {sum.r + seen.r, sum.g + seen.g, sum.b + seen.b};
    }
    sum = scaled(sum, 1.0f / all_samples);
    return {to_srgb(sum.r), to_srgb(sum.g), to_srgb(sum.b)};
  }

 private:
  // All samples of a pixel share out one well spread set of directions, turned by an angle of the pixel's own.
  struct Sample {
    int number;
    float cosine, sine;

    DiscPoint pick(const std::vector<DiscPoint>& points, int i) const {
      const DiscPoint& p = points[i * all_samples + number];
      return {p.x * cosine - p.y * sine, p.x * sine + p.y * cosine, p.radius2};
    }
  };

  Rgb sample(float x, float y, Sample which, Rgb behind) const {
    const Ray ray = stage_.camera.ray(x, y);
    const Hit hit = stage_.scene.first_hit(ray);
    if (hit.what == Hit::What::nothing) return behind;
    const bool sphere = hit.what == Hit::What::sphere;
    const Rgb albedo = sphere ? albedo_[hit.index] : wall_;
    if (stage_.camera.flat) return sphere ? scaled(albedo, 0.72f + 0.28f * hit.normal.z()) : albedo;
    const Rgb lit = light(ray, hit, albedo, which);
    if (sphere) return lit;
    const float away = (hit.point.norm() - fade_from) / (fade_to - fade_from);
    const float t = std::clamp(away, 0.0f, 1.0f);
    return mix(lit, behind, t * t * (3 - 2 * t));
  }

  Rgb background(int y) const {
    const float down = static_cast<float>(y) / static_cast<float>(stage_.camera.height);
    return to_linear(mix(background_top, background_bottom, down));
  }

  Rgb light(const Ray& ray, const Hit& hit, Rgb albedo, Sample which) const {
    const float facing = hit.normal.dot(lamp_);
    const auto [lamp, sky] = open_share(hit, facing > 0, which);
    const float upward = 0.5f + 0.5f * hit.normal.dot(sky_up_);
    const float diffuse = sky * (ground_light + upward * (sky_light - ground_light)) + lamp_light * lamp * facing;
    const Vec3f half = (lamp_ - ray.direction).normalized();
    const bool shiny = hit.what == Hit::What::sphere;
    return scaled(albedo, diffuse, shiny ? gloss * lamp * std::pow(std::max(half.dot(hit.normal), 0.0f), 40.0f) : 0);
  }

  struct Open {
    float lamp, sky;
  };
  // The shares of the lamp and of the sky that are not hidden, with one packet of rays.
  Open open_share(const Hit& hit, bool lamp_ahead, Sample which) const {
    const Frame frame = frame_of(hit.normal);
    std::array<Vec3f, RayScene::rays> directions;
    std::array<float, RayScene::rays> reach;
    for (int i = 0; i < lamp_rays; ++i) {
      const DiscPoint p = which.pick(lamp_points_, i);
      directions[i] = (lamp_ + lamp_size * (p.x * lamp_frame_.a + p.y * lamp_frame_.b)).normalized();
      reach[i] = lamp_ahead ? 10.0f : 0.0f;
    }
    for (int i = 0; i < sky_rays; ++i) {
      // Spread by the cosine about the normal: every free ray then counts the same.
      const DiscPoint p = which.pick(sky_points_, i);
      directions[lamp_rays + i] = p.x * frame.a + p.y * frame.b + std::sqrt(1 - p.radius2) * hit.normal;
      reach[lamp_rays + i] = sky_reach;
    }
    // Start a little off the surface, or rounding would let it shade itself.
    const float clear = 1e-3f * stage_.radius + 4e-6f * (1 + hit.point.norm());
    const auto free = stage_.scene.free_ways(hit.point + clear * hit.normal, directions, reach);
    Open open{0, 0};
    for (int i = 0; i < lamp_rays; ++i) open.lamp += free[i] / lamp_rays;
    for (int i = lamp_rays; i < RayScene::rays; ++i) open.sky += free[i] / sky_rays;
    return open;
  }

  const Stage& stage_;
  Vec3f lamp_, sky_up_;
  Frame lamp_frame_;
  const std::vector<DiscPoint> lamp_points_ = sunflower(lamp_rays * all_samples);
  const std::vector<DiscPoint> sky_points_ = sunflower(sky_rays * all_samples);
  std::vector<Rgb> albedo_;
  Rgb wall_;
};

}  // namespace

Picture trace(const Stage& stage) {
  Picture picture{stage.camera.width, stage.camera.height, {}};
  picture.rgb.resize(std::size_t{3} * picture.width * picture.height);
  const Tracer tracer(stage);
  std::atomic<int> next_row{0};
  const auto work = [&] {
    for (int y = next_row++; y < picture.height; y = next_row++)
      for (int x = 0; x < picture.width; ++x) {
        const Rgb colour = tracer.pixel(x, y);
        unsigned char* out = &picture.rgb[3 * (static_cast<std::size_t>(y) * picture.width + x)];
        out[0] = to_byte(colour.r), out[1] = to_byte(colour.g), out[2] = to_byte(colour.b);
      }
  };
  std::vector<std::jthread> helpers;
  for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) helpers.emplace_back(work);
  work();
  helpers.clear();  // waits for them
  return picture;
}

}  // namespace molten::picture
