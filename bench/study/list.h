// The cases, one file each.
#pragma once

#include "bench/study/case.h"

namespace molten::study {

Case taylor_green();
Case hot_spot();
Case two_slabs();
Case cavity();
Case couette();
Case poiseuille();
Case smd_channel();
Case bingham_channel();
Case standing_wave();
Case hydrostatic_box();
Case hydrostatic_bowl();
Case slope_yield();
Case floating_box();
Case vent_flux();
Case elliptic_drop();
Case rotating_patch();
Case cruchaga_a();
Case cruchaga_b();
Case lobovsky_front();
Case lobovsky_pressure();
Case martin_moyce();
Case koshizuka();
Case kleefsman();
Case dias_a();
Case dias_b();
Case dias_lobovsky();
Case dias_tank();

}  // namespace molten::study
