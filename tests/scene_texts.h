// Scene texts that the tests of scene files start from, and what parse_scene says to a changed one.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "io/scene/scene_file.h"
#include "tests/replaced.h"

namespace molten::scene_texts {

inline const std::string good = R"(# line 1
[scene]
title = "A good scene"
gravity = [0.0, 0.0, -9.81]
periodic = ["x"]
domain = { min = [0, 0, 0], max = [2, 2, 2] }

[fluid]
particles = 1000
density = 1200.0

[[fluid.body]]
sphere = { center = [1, 1, 1], radius = 0.5 }
velocity = [0, 0, -1]
temperature = 80

[[fluid.body]]
polygon = { points = [[0, 0], [0, 1], [1, 1], [1, 0]], bottom = 0, top = 0.1 }

[fluid.rheology]
model = "smd"
n = 0.5
jump_number = [15, 150]
yield_stress = 60.0
consistency = 20.0

[fluid.heat]
diffusivity = 1e-4
melting_range = [40, 60]
initial = { bottom = 20.0, top = 90.0 }

[[boundary]]
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
slip = 0.5

[[boundary]]
cylinder = { base = [1, 1, 0], radius = 0.9, height = 2 }
inside = true
restitution = 0.2

[run]
end_time = 0.4
max_steps = 100

[output]
frames_per_second = 50
fields = ["density", "temperature"]
checkpoint_every = "5 min"

[numerics]
preset = "paiva"
precision = "double"
kernel = "gaussian"
xsph = { epsilon = 0.4 }
courant = { sound = 0.15 }
)";

// As the design prints it: keys side by side.
inline const std::string design = R"([scene]      title = "Bunny melts from the ears down"   # dimensions = 3
[fluid]      mesh = "models/bunny.obj"  height = 0.15  particles = 10188  density = 1000.0
[fluid.rheology]  model = "smd"  n = 0.5  jump_number = [15, 150]  yield_stress = 60.0  consistency = 20.0   # hot, cold; Pa
[fluid.heat] diffusivity = 1e-4  melting_range = [40, 60]  initial = { bottom = 20.0, top = 90.0 }
[[boundary]] plane = { point = [0,0,0], normal = [0,0,1] }  slip = 0.0  restitution = 0.0
[run]        end_time = 0.4
[output]     frames_per_second = 25  checkpoint_every = "5 min"
)";

inline const std::string flat = R"([scene]
dimensions = 2
[fluid]
box = { min = [0, 0], max = [1, 2] }
spacing = 0.03
[run]
end_time = 1
)";

/// The message that the text ends in; empty when it is a good scene.
inline std::string complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_scene(text, "s.toml", overrides);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    return error.what();
  }
}

inline void expect_complaint(const std::string& message, const std::string& fragment) {
  EXPECT_NE(message.find(fragment), std::string::npos) << "said: " << message << "\nnot:  " << fragment;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

}  // namespace molten::scene_texts
