#include "bench/study/list.h"

namespace molten::study {

const std::vector<Case>& all_cases() {
  static const std::vector<Case> cases{
      taylor_green(),   hot_spot(),          two_slabs(),     cavity(),          couette(),          poiseuille(),
      smd_channel(),    bingham_channel(),   standing_wave(), hydrostatic_box(), hydrostatic_bowl(), slope_yield(),
      floating_box(),   vent_flux(),         elliptic_drop(), rotating_patch(),  cruchaga_a(),       cruchaga_b(),
      lobovsky_front(), lobovsky_pressure(), martin_moyce(),  koshizuka(),       kleefsman(),        dias_a(),
      dias_b(),         dias_lobovsky(),     dias_tank()};
  return cases;
}

}  // namespace molten::study
