// The walls' share of a pair pass. A piece s of a wall goes through the terms as one neighbour behind its plane, with
// ∫_solid ∇W dV = −∫_s W n dS (Gauss; Chiron et al. 2019) in the place of V_j ∇W_ij and the values of the fluid at the
// wall. With h = ∫_solid W dV behind a facet and y from the particle:
// - Pressure: p_i, and what a mirrored hydrostatic fluid behind the wall adds, Σ n (∫ W g·y dS − h g·n) over the
//   facets: exact for pressures linear along n.
// - Continuity: the mirrored velocity, so twice (v_i − v_wall)·n. These two are each other's adjoint, so that walls do
//   not feed sound waves: with the renormalised form of Ferrand et al. 2013, which is not, a tank at rest keeps 300
//   times the kinetic energy, and without density diffusion it does not come to rest at all. Fluid without pressure
//   that leaves a wall, or that a wall leaves, is not stretched: there the gap fills with air. Else what is under the
//   edge of a rising gate is torn, and the front that springs from there hits three times too hard.
// - Along the wall a particle misses the part h of its support: its acceleration is multiplied by
//   (1 − Σ h (1 − n n))^−1. Sums for the strain rate are divided by 1 − Σ h (Ferrand et al. 2013), which makes them
//   exact for linear fields, and the viscous flux for quadratic ones, at a plane.
// - Heat: a wall with a temperature conducts as a neighbour, exact for temperatures linear along n; what the others
//   hide the pairs make up for themselves, so that heat is kept (insulation.h).
// - Bodies: their pieces move with them. What a particle gets beside the pair forces, which are each other's opposite,
//   comes from the walls, so a body gets the opposite of its share, at the particle: linear and angular momentum stay.
#pragma once

#include <Eigen/LU>
#include <span>
#include <tuple>
#include <vector>

#include "core/boundary/wall_integrals.h"
#include "core/boundary/wall_support.h"
#include "core/pair_pass.h"
#include "core/physics/heat_interface.h"
#include "core/physics/insulation.h"

namespace molten {
namespace wall_terms_detail {

/// A piece of a wall as the neighbour of the particles in the lanes of L.
template <int Dim, class L> struct WallNeighbour {
  Vec<Dim, L> normal, velocity;  // velocity: of the wall, m/s
  Vec<Dim, L> pull;              // by the hydrostatic part of p_s, m/s²
  SymTensor<Dim, L> moment;      // of ∫_s n ⊗ W y dS, the symmetric part
  L reach, weight, hidden;       // m, 1/m, 1; reach: of the neighbour, straight along the normal
  L height;                      // m, that its temperature is off
};

template <int Dim, class Real>
WallNeighbour<Dim, Lanes<Real, 1>> neighbour_of(const WallPatch<Dim>& patch, const Point<Dim>& gravity) {
  using L = Lanes<Real, 1>;
  // Further off where the piece is aside: fluxes go by the slope along the normal, (n · y)/y² for a piece at y.
  const double aside = patch.centroid.norm();
  const Point<Dim> pull = (patch.moment - patch.across) * gravity;
  WallNeighbour<Dim, L> n;
  for (int k = 0; k < Dim; ++k) {
    n.normal[k] = L(static_cast<Real>(patch.normal[k]));
    n.pull[k] = L(static_cast<Real>(pull[k]));
    for (int m = k; m < Dim; ++m) n.moment(k, m) = L(static_cast<Real>((patch.moment(k, m) + patch.moment(m, k)) / 2));
  }
  n.reach = L(static_cast<Real>(aside * aside / std::max(patch.distance, 0.1 * aside)));
  // Its temperature is the same all over its plane, so what heat goes by is the height over that; but not where the
  // plane passes close by and the piece is aside.
  n.height = L(static_cast<Real>(std::max(patch.distance, 0.5 * aside)));
  n.weight = L(static_cast<Real>(patch.weight));
  n.hidden = L(static_cast<Real>(patch.hidden));
  return n;
}

template <int I, int Dim, class Real, class... F>
Values<FieldList<F...>, Dim, Lanes<Real, I>> load_own(const Particles<Dim, Real>& particles, std::size_t slot,
                                                      FieldList<F...>) {
  Values<FieldList<F...>, Dim, Lanes<Real, I>> v;
  const auto one = [&]<class G>(G) {
    const auto column = particles[G{}];
    unrolled<components<G, Dim>>(
        [&](auto k) { component(v[G{}], k) = column[k] ? load<I>(column[k] + slot) : Lanes<Real, I>(Real(0)); });
  };
  (one(F{}), ...);
  return v;
}

}  // namespace wall_terms_detail

/// A finish of a pair pass that adds the walls' share first. Terms of the pass with an `at_walls` do not concern walls;
/// those with a `behind_wall` add what they make of the solid themselves, those with a `before_wall` take another form.
template <int Dim, class Real, class Finish, class... Terms> class WithWalls {
  template <class L> using Neighbour = wall_terms_detail::WallNeighbour<Dim, L>;
  using Reads = typename UnionOf<FieldList<Compression>, typename Terms::Reads...>::type;
  using Radial = typename UnionOf<typename pair_pass_detail::RadialOf<Terms>::type...>::type;

 public:
  WithWalls(const WallSupport<Dim>& walls, const Parameters<Dim>& parameters, const Particles<Dim, Real>& particles,
            const Finish& finish, const Terms&... terms)
      : walls_(walls), parameters_(parameters), particles_(particles), finish_(finish), terms_(terms...) {
    for (int d = 0; d < Dim; ++d) gravity_[d] = parameters.gravity[d];
  }

  /// What the particles of each chunk receive from bodies is added to `given`, one set for each chunk.
  WithWalls giving(std::span<Kick<Dim>> given) const {
    WithWalls other(*this);
    other.given_ = given;
    return other;
  }

  auto for_chunk(std::size_t number) const {
    const std::span<Kick<Dim>> given = given_.subspan(number * walls_.bodies(), given_.empty() ? 0 : walls_.bodies());
    return [this, given, inner = finish_.for_chunk(number)](std::size_t slot, const auto& sums) mutable {
      const std::int32_t plane = walls_.plane(slot / cluster_size);
      if (plane == WallSupport<Dim>::no_plane) return inner(slot, sums);
      auto whole = sums;
      plane == WallSupport<Dim>::many_planes ? add_many(slot, whole, given) : add_plane(slot, plane, whole);
      inner(slot, whole);
    };
  }

 private:
  /// One plane that ends nowhere near: all lanes at once.
  template <class... F, int I>
  [[gnu::noinline]] void add_plane(std::size_t slot, std::int32_t plane,
                                   Values<FieldList<F...>, Dim, Lanes<Real, I>>& sums) const {
    using L = Lanes<Real, I>;
    Neighbour<L> n;
    const std::int32_t wall = from_plane<I>(slot, plane, n);
    Values<FieldList<F...>, Dim, L> walls;
    pair_pass_detail::clear(walls);
    add_neighbour(n, walls_.wall(wall), wall_terms_detail::load_own<I>(particles_, slot, Reads{}), walls);
    const L along = reciprocal(L(Real(1)) - n.hidden);
    (join(F{}, sums[F{}], walls[F{}], along,
          [&](const Vec<Dim, L>& a) {
            const Vec<Dim, L> across = dot(a, n.normal) * n.normal;
            return across + along * (a - across);
          }),
     ...);
  }

  template <int I> std::int32_t from_plane(std::size_t slot, std::int32_t plane, Neighbour<Lanes<Real, I>>& n) const {
    using L = Lanes<Real, I>;
    const auto x = particles_[position];
    const auto& [normal, offset, wall] = walls_.integrals().plane(plane);
    Lanes<double, I> height(-offset);
    for (int d = 0; d < Dim; ++d) height += Lanes<double, I>(normal[d]) * load<I>(x[d] + slot);
    unrolled<I>([&](auto k) {  // a lane's number has to be known, or it goes through memory
      const double distance = lane(height, k);
      const RadialIntegrals::Plane beyond = walls_.integrals().of_plane(distance);
      set_lane(n.weight, k, static_cast<Real>(beyond.weight));
      set_lane(n.hidden, k, static_cast<Real>(beyond.hidden));
      set_lane(n.reach, k, static_cast<Real>(beyond.weight > 0 ? distance : 1));
    });
    n.height = n.reach;
    const L moment = n.reach * n.weight;
    const L pull = L(static_cast<Real>(-gravity_.dot(normal))) * (moment + n.hidden);
    const L centre = L(Real(-0.5)) * moment;  // along the normal
    for (int d = 0; d < Dim; ++d) {
      n.normal[d] = L(static_cast<Real>(normal[d]));
      n.pull[d] = pull * n.normal[d];
    }
    n.velocity = lanes_of<L>(walls_.wall(wall).skin.velocity_along(normal));
    n.moment = twice_symmetric(centre * n.normal, n.normal);
    return wall;
  }

  /// Corners, edges, curved walls: particle by particle.
  template <class... F, int I>
  [[gnu::noinline]] void add_many(std::size_t slot, Values<FieldList<F...>, Dim, Lanes<Real, I>>& sums,
                                  std::span<Kick<Dim>> given) const {
    for (int k = 0; k < I; ++k) {
      if (particles_.is_padding(slot + k)) continue;
      Values<FieldList<F...>, Dim, Lanes<Real, 1>> own;
      (unrolled<components<F, Dim>>(
           [&](auto c) { component(own[F{}], c) = Lanes<Real, 1>(lane(component(sums[F{}], c), k)); }),
       ...);
      add_many_to_one(slot + k, own, given);
      (unrolled<components<F, Dim>>(
           [&](auto c) { set_lane(component(sums[F{}], c), k, lane(component(own[F{}], c), 0)); }),
       ...);
    }
  }

  using Matrix = Eigen::Matrix<double, Dim, Dim>;

  /// What a particle receives from a body: at once, and of what it gets in the end.
  struct Share {
    std::int32_t body;
    Point<Dim> acceleration = Point<Dim>::Zero();
    Matrix along = Matrix::Zero();
  };

  template <class... F>
  void add_many_to_one(std::size_t slot, Values<FieldList<F...>, Dim, Lanes<Real, 1>>& sums,
                       std::span<Kick<Dim>> given) const {
    using L = Lanes<Real, 1>;
    const auto own = wall_terms_detail::load_own<1>(particles_, slot, Reads{});
    Values<FieldList<F...>, Dim, L> walls;
    pair_pass_detail::clear(walls);
    double hidden = 0;
    Matrix along = Matrix::Zero();  // Σ h (1 − n n)
    Point<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = particles_[position][d][slot];
    std::vector<Share> shares;
    walls_.visit(slot, x, [&](const WallPatch<Dim>& patch) {
      const Wall<Dim>& wall = walls_.wall(patch.wall);
      auto n = wall_terms_detail::neighbour_of<Dim, Real>(patch, gravity_);
      n.velocity = lanes_of<L>(velocity_of(wall, patch, x, walls_));
      const auto before = walls;
      add_neighbour(n, wall, own, walls);
      const Matrix part = patch.hidden * Matrix::Identity() - patch.across;
      hidden += patch.hidden;
      along += part;
      if constexpr (is_among<Acceleration, FieldList<F...>>) {
        if (given.empty() || wall.body < 0) return;
        if (shares.empty() || shares.back().body != wall.body) shares.push_back({wall.body});
        shares.back().acceleration += point_of(walls[acceleration]) - point_of(before[acceleration]);
        shares.back().along += part;
      }
    });
    const double limited = std::min(hidden, most_hidden);
    const double kept = hidden > limited ? limited / hidden : 1;
    along *= kept;
    (join(F{}, sums[F{}], walls[F{}], L(static_cast<Real>(1 / (1 - limited))),
          [&](const Vec<Dim, L>& a) { return lanes_of<L>((Matrix::Identity() - along).inverse() * point_of(a)); }),
     ...);
    if constexpr (is_among<Acceleration, FieldList<F...>>)
      for (const Share& share : shares) {
        // What multiplies the acceleration, (1 − A)^−1, adds A times what comes out.
        const Point<Dim> gain = share.acceleration + kept * share.along * point_of(sums[acceleration]);
        Kick<Dim>& kick = given[static_cast<std::size_t>(share.body)];
        kick.linear += gain;
        kick.angular += moment_of(Point<Dim>(x - walls_.motion(share.body).start.centre), gain);
      }
  }

  static Point<Dim> velocity_of(const Wall<Dim>& wall, const WallPatch<Dim>& patch, const Point<Dim>& x,
                                const WallSupport<Dim>& walls) {
    if (wall.body < 0) return wall.skin.velocity_along(patch.normal);
    const RigidMotion<Dim>& motion = walls.motion(wall.body);
    return motion.velocity_at(x + patch.centroid, motion.start.centre);
  }
  template <class L> static Point<Dim> point_of(const Vec<Dim, L>& v) {
    Point<Dim> p;
    for (int d = 0; d < Dim; ++d) p[d] = lane(v[d], 0);
    return p;
  }
  template <class L> static Vec<Dim, L> lanes_of(const Point<Dim>& p) {
    Vec<Dim, L> v;
    for (int d = 0; d < Dim; ++d) v[d] = L(static_cast<Real>(p[d]));
    return v;
  }

  /// What the terms make of one neighbour.
  template <class L, class Own, class Sums>
  void add_neighbour(const Neighbour<L>& n, const Wall<Dim>& wall, const Own& i, Sums& sums) const {
    Pair<Dim, L> ij;
    ij.x = n.reach * n.normal;
    ij.r2 = n.reach * n.reach;
    const L density = L(static_cast<Real>(parameters_.eos.rest_density)) * (L(Real(1)) + i[compression]);
    const ShapeAndSlope<L> kernel{L(Real(0)), -(density * n.weight) / n.reach};
    const auto j = at_wall(n, wall, i, Reads{});
    pair_pass_detail::Out<typename Sums::List, Radial, Dim, L> out{sums, kernel, {}};
    pair_pass_detail::clear(out.radial);
    const auto add = [&]<class Term>(const Term& term) {
      if constexpr (requires { term.behind_wall(n, density, out); }) {
        term.behind_wall(n, density, out);
      } else if constexpr (requires { term.before_wall(ij, i, j, out); }) {
        if (term.on) term.before_wall(ij, i, j, out);
      } else if constexpr (!requires { Term::at_walls; }) {
        if (term.on) term(ij, i, j, out);
      }
    };
    std::apply([&](const Terms&... term) { (add(term), ...); }, terms_);
    out.add_radial(Radial{}, ij.x);
    if constexpr (is_among<PressureTerm, Reads>) sums[acceleration] += n.pull;
  }

  // ---- the fields of the fluid at a wall, from those of the particle
  // --------------------------------------------------

  template <class L, class Own, class... F>
  Values<FieldList<F...>, Dim, L> at_wall(const Neighbour<L>& n, const Wall<Dim>& wall, const Own& i,
                                          FieldList<F...>) const {
    Values<FieldList<F...>, Dim, L> values;
    ((values[F{}] = at_wall(F{}, n, wall, i)), ...);
    return values;
  }
  template <class F, class L, class Own>
  auto at_wall(F field, const Neighbour<L>&, const Wall<Dim>&, const Own& i) const {
    return i[field];
  }
  template <class L, class Own>
  Vec<Dim, L> at_wall(Velocity, const Neighbour<L>& n, const Wall<Dim>& wall, const Own& i) const {
    const Vec<Dim, L> beyond = i[velocity] - n.velocity;
    const L away = dot(beyond, n.normal), zero(Real(0));
    // A wall does not pull at fluid that leaves it, unless that is pressed: the gap fills with air.
    const L gap = select_less(i[compression], zero, select_less(zero, away, away, zero), zero);
    return n.velocity + L(static_cast<Real>(wall.response.slip)) * (beyond - away * n.normal) + gap * n.normal;
  }
  template <class L, class Own>
  L at_wall(LocalTemperature, const Neighbour<L>& n, const Wall<Dim>& wall, const Own& i) const {
    const WallSkin<Dim>& skin = wall.skin;
    if (!skin.temperature) return i[local_temperature];
    // The terms take a slope over `reach`.
    const L temperature = temperature_of(skin, n, i);
    return i[local_temperature] + n.reach / n.height * (temperature - i[local_temperature]);
  }
  template <class L, class Own> L temperature_of(const WallSkin<Dim>& skin, const Neighbour<L>& n, const Own& i) const {
    const L there(static_cast<Real>(*skin.temperature - parameters_.reference_temperature));
    if (skin.layer_diffusivity <= 0) return there;
    // The flux through the layer is that through the fluid: k (T_i − T)/height = k_l (T − T_behind)/thickness.
    const L layer(static_cast<Real>(skin.layer_diffusivity / skin.layer_thickness));
    L own = L(static_cast<Real>(parameters_.diffusivity)) / n.height;
    if constexpr (is_among<InterfaceResistance, Reads>)
      if (particles_.has(conductivity))
        own = own * series_conductivity<Real>(i[interface_distance], i[interface_resistance]);
    // The term multiplies its fluxes by this; the layer's is right without.
    if constexpr (is_among<LaplacianCorrection, Reads>) own = own * i[laplacian_correction];
    return (own * i[local_temperature] + layer * there) / (own + layer);
  }

  // ---- how the sums over the fluid and over the walls become one
  // ------------------------------------------------------

  template <class L, class Along> static void join(CompressionRate, L& sum, const L& walls, const L&, const Along&) {
    sum += L(Real(2)) * walls;
  }
  // What measures the support itself: solid and fluid make up the whole of it.
  template <class L, class V, class Along> static void join(Moment, V& sum, const V& walls, const L&, const Along&) {
    sum += walls;
  }
  template <class L, class Along> static void join(KernelSum, L& sum, const L& walls, const L&, const Along&) {
    sum += walls;
  }
  template <class L, class V, class Along>
  static void join(CrowdingGradient, V& sum, const V& walls, const L&, const Along&) {
    sum += walls;
  }
  template <class L, class Along>  // its pairs are whole already
  static void join(TemperatureRate, L& sum, const L& walls, const L&, const Along&) {
    sum += walls;
  }
  template <class L, class Along>  // a sum of W, not of ∇W
  static void join(XsphVelocity, Vec<Dim, L>&, const Vec<Dim, L>&, const L&, const Along&) {}
  template <class L, class Along>
  static void join(Acceleration, Vec<Dim, L>& sum, const Vec<Dim, L>& walls, const L&, const Along& along) {
    sum = along(sum + walls);
  }
  template <class F, class V, class L, class Along>
  static void join(F, V& sum, const V& walls, const L& whole, const Along&) {
    unrolled<components<F, Dim>>(
        [&](auto k) { component(sum, k) = whole * (component(sum, k) + component(walls, k)); });
  }

  const WallSupport<Dim>& walls_;
  const Parameters<Dim>& parameters_;
  const Particles<Dim, Real>& particles_;
  const Finish& finish_;
  std::tuple<const Terms&...> terms_;
  Point<Dim> gravity_;
  std::span<Kick<Dim>> given_;  // by chunk and body
};

}  // namespace molten
