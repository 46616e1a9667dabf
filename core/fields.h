// Every per-particle quantity, once: its shape, how it is stored, its unit and meaning. Columns, frames and checkpoints
// are made from this list; a scene's particles hold only the columns that its features name (features.h).
#pragma once

#include <cstdint>
#include <string_view>
#include <type_traits>

#include "core/vec.h"

namespace molten {

enum class FieldShape { scalar, vector, tensor, third, fourth };  // tensor and beyond: symmetric, of that rank
enum class Storage { real, exact, id };  // real: the run's precision; exact: double; id: 64-bit integer

enum class Lifetime { run, step };  // step: made anew before each use, so it need not follow a sort

template <FieldShape shape_, Storage storage_, Lifetime lifetime_ = Lifetime::run> struct Field {
  static constexpr FieldShape shape = shape_;
  static constexpr Storage storage = storage_;
  static constexpr Lifetime lifetime = lifetime_;
};

using ScalarField = Field<FieldShape::scalar, Storage::real>;
using VectorField = Field<FieldShape::vector, Storage::real>;
using StepScalar = Field<FieldShape::scalar, Storage::real, Lifetime::step>;
using StepVector = Field<FieldShape::vector, Storage::real, Lifetime::step>;
using StepTensor = Field<FieldShape::tensor, Storage::real, Lifetime::step>;
using StepThird = Field<FieldShape::third, Storage::real, Lifetime::step>;
using StepFourth = Field<FieldShape::fourth, Storage::real, Lifetime::step>;

#define MOLTEN_FIELD(Type, Base, tag, unit_, meaning_)    \
  struct Type : Base {                                    \
    static constexpr std::string_view name = #tag;        \
    static constexpr std::string_view unit = unit_;       \
    static constexpr std::string_view meaning = meaning_; \
  };                                                      \
  inline constexpr Type tag {}

using ExactVector = Field<FieldShape::vector, Storage::exact>;
using ExactScalar = Field<FieldShape::scalar, Storage::exact>;
using IdScalar = Field<FieldShape::scalar, Storage::id>;

// What a particle is.
MOLTEN_FIELD(Id, IdScalar, id, "1", "number given at the start, kept for life; -1: padding slot");
MOLTEN_FIELD(Position, ExactVector, position, "m", "position");
MOLTEN_FIELD(Velocity, VectorField, velocity, "m/s", "velocity at the time of the rates");
MOLTEN_FIELD(Compression, ScalarField, compression, "1", "density / rest density - 1");
MOLTEN_FIELD(Temperature, ExactScalar, temperature, "degrees", "temperature");

MOLTEN_FIELD(Conductivity, ScalarField, conductivity, "1", "thermal conductivity over that of the scene");

MOLTEN_FIELD(InterfaceDistance, ScalarField, interface_distance, "1",
             "distance from what conducts differently, over the kernel's reach");
MOLTEN_FIELD(InterfaceResistance, ScalarField, interface_resistance, "1", "that distance over the conductivity");
MOLTEN_FIELD(HeatCompletion, ScalarField, heat_completion, "1",
             "factor that makes up for the support behind insulating walls");

MOLTEN_FIELD(Inlet, IdScalar, inlet, "1", "number of the vent that still pushes the particle; -1: none");

MOLTEN_FIELD(Held, ScalarField, held, "1",
             "0: fluid; 1: boundary particle that stays; k + 2: one that moves with body k");

// What an integrator carries beside it.
MOLTEN_FIELD(HalfVelocity, VectorField, half_velocity, "m/s", "leap-frog velocity, half a step behind");
MOLTEN_FIELD(HalfCompression, ScalarField, half_compression, "1", "leap-frog compression, half a step behind");
MOLTEN_FIELD(PreviousCompressionRate, ScalarField, previous_compression_rate, "1/s", "compression rate one step ago");
MOLTEN_FIELD(BasePosition, ExactVector, base_position, "m", "position at the start of the step");
MOLTEN_FIELD(BaseVelocity, VectorField, base_velocity, "m/s", "velocity at the start of the step");
MOLTEN_FIELD(BaseCompression, ScalarField, base_compression, "1", "compression at the start of the step");
MOLTEN_FIELD(BaseTemperature, ExactScalar, base_temperature, "degrees", "temperature at the start of the step");
MOLTEN_FIELD(PositionSlope, ExactVector, position_slope, "m/s", "weighted sum of the stages' rates of position");
MOLTEN_FIELD(VelocitySlope, VectorField, velocity_slope, "m/s2", "weighted sum of the stages' accelerations");
MOLTEN_FIELD(CompressionSlope, ScalarField, compression_slope, "1/s", "the same of the rates of compression");
MOLTEN_FIELD(TemperatureSlope, ExactScalar, temperature_slope, "K/s", "the same of the rates of temperature");
MOLTEN_FIELD(OlderCompressionRate, ScalarField, older_compression_rate, "1/s", "compression rate two steps ago");
MOLTEN_FIELD(RestTime, ScalarField, rest_time, "s", "time since the particle last moved or its density changed");
MOLTEN_FIELD(HeatRestTime, ScalarField, heat_rest_time, "s", "time since its temperature last changed");
MOLTEN_FIELD(RestTemperature, ScalarField, rest_temperature, "degrees", "temperature when it was last active");

// What the passes compute for each other, from the above.
MOLTEN_FIELD(LocalPosition, StepVector, local_position, "m",
             "position relative to the cluster's origin, on the grid's quantum");
MOLTEN_FIELD(LocalTemperature, StepScalar, local_temperature, "K", "temperature less the run's reference temperature");
MOLTEN_FIELD(PressureTerm, StepScalar, pressure_term, "Pa m6/kg2", "pressure / density^2");
MOLTEN_FIELD(Viscosity, StepScalar, viscosity, "Pa s", "dynamic viscosity");
MOLTEN_FIELD(Stress, StepTensor, stress, "Pa m6/kg2", "viscous stress / density^2");
MOLTEN_FIELD(Acceleration, StepVector, acceleration, "m/s2", "acceleration");
MOLTEN_FIELD(CompressionRate, StepScalar, compression_rate, "1/s", "rate of compression");
MOLTEN_FIELD(TemperatureRate, StepScalar, temperature_rate, "K/s", "rate of temperature");
MOLTEN_FIELD(InternalEnergy, ExactScalar, internal_energy, "J/kg",
             "internal energy since the start; leap-frog: half a step behind");
MOLTEN_FIELD(InternalEnergyRate, StepScalar, internal_energy_rate, "W/kg", "rate of internal energy");
MOLTEN_FIELD(EnergyShare, StepScalar, energy_share, "1", "share of the acceleration that the energy bound lets act");
MOLTEN_FIELD(FilteredCompression, StepScalar, filtered_compression, "1", "compression after the density filter");
MOLTEN_FIELD(Correction, StepTensor, correction, "1", "kernel-gradient correction L");
MOLTEN_FIELD(LaplacianCorrection, StepScalar, laplacian_correction, "1", "factor that makes Laplacians whole");
MOLTEN_FIELD(LaplacianTilt, StepVector, laplacian_tilt, "1/m", "linear part of what the weights of Laplacians gain");
MOLTEN_FIELD(LaplacianBend, StepTensor, laplacian_bend, "1/m2", "quadratic part of it");
MOLTEN_FIELD(Inner, StepScalar, inner, "1", "1: deep in the fluid; 0: at its surface");
MOLTEN_FIELD(ShiftVelocity, StepVector, shift_velocity, "m/s", "velocity of the particle less that of the fluid");
MOLTEN_FIELD(CouplingRate, StepScalar, coupling_rate, "1/s", "what the places lack in compression, times a rate");
MOLTEN_FIELD(XsphVelocity, StepVector, xsph_velocity, "m/s", "XSPH correction of the velocity, before its factor");

MOLTEN_FIELD(StrainRate, StepTensor, strain_rate, "1/s", "rate of strain, grad v + its transpose");
MOLTEN_FIELD(Vorticity, StepVector, vorticity, "1/s", "curl of the velocity; 2-D: the first component");
MOLTEN_FIELD(Thinning, StepScalar, thinning, "1", "-d ln viscosity / d ln strain rate, halved");

MOLTEN_FIELD(StiffAcceleration, StepVector, stiff_acceleration, "m/s2",
             "acceleration by viscous forces of stiff clusters, before the first stage");
MOLTEN_FIELD(StartVelocity, StepVector, start_velocity, "m/s", "velocity before the first stage; symplectic Euler");
MOLTEN_FIELD(StageChange, StepVector, stage_change, "m/s", "what the stages so far have made of the velocity");
MOLTEN_FIELD(EarlierChange, StepVector, earlier_change, "m/s", "the same, one stage earlier");

// Sums that a pass uses up itself; never a column.
MOLTEN_FIELD(Moment, StepTensor, moment, "kg/m3", "sum of m_j grad W times x_ij, for the correction");
MOLTEN_FIELD(FirstMoment, StepVector, first_moment, "kg/m4", "sum of m_j W'/r times x_ij, for consistent Laplacians");
MOLTEN_FIELD(ThirdMoment, StepThird, third_moment, "kg/m2", "sum of m_j W'/r times x_ij x_ij x_ij");
MOLTEN_FIELD(FourthMoment, StepFourth, fourth_moment, "kg/m", "sum of m_j W'/r times x_ij x_ij x_ij x_ij");
MOLTEN_FIELD(CrowdingGradient, StepVector, crowding_gradient, "kg/m4", "sum of m_j grad W, for shifting");
MOLTEN_FIELD(Parting, StepVector, parting, "kg/m4", "the same of neighbours that are too near, with weights");
MOLTEN_FIELD(KernelSum, StepScalar, kernel_sum, "kg/m3", "sum of m W, with weights");
MOLTEN_FIELD(KernelMean, StepScalar, kernel_mean, "kg/m3", "the same times the compression");
MOLTEN_FIELD(KernelMoment, StepVector, kernel_moment, "kg/m2", "the same sum times x_ij");
MOLTEN_FIELD(KernelMomentOfMean, StepVector, kernel_moment_of_mean, "kg/m2", "the same times compression and x_ij");
MOLTEN_FIELD(KernelSpread, StepTensor, kernel_spread, "kg/m", "the same times x_ij x_ij");

#undef MOLTEN_FIELD

template <class... F> struct FieldList { static constexpr int size = sizeof...(F); };

/// All fields that can be columns, in the order of files.
using AllFields =
    FieldList<Id, Position, Velocity, Compression, Temperature, HalfVelocity, HalfCompression, PreviousCompressionRate,
              OlderCompressionRate, LocalPosition, LocalTemperature, PressureTerm, Viscosity, Stress, Acceleration,
              CompressionRate, TemperatureRate, XsphVelocity, Correction, LaplacianCorrection, ShiftVelocity,
              BasePosition, BaseVelocity, BaseCompression, BaseTemperature, PositionSlope, VelocitySlope,
              CompressionSlope, TemperatureSlope, FilteredCompression, InternalEnergy, InternalEnergyRate, EnergyShare,
              RestTime, HeatRestTime, RestTemperature, Inlet, Held, StrainRate, Vorticity, Thinning, Inner,
              CouplingRate, StiffAcceleration, StartVelocity, StageChange, EarlierChange, LaplacianTilt, LaplacianBend,
              Conductivity, InterfaceDistance, InterfaceResistance, HeatCompletion>;

// ---- list arithmetic at compile time --------------------------------------------------------------------------------

template <class F, class List> struct IndexOf;
template <class F, class... Rest> struct IndexOf<F, FieldList<F, Rest...>> { static constexpr int value = 0; };
template <class F, class G, class... Rest> struct IndexOf<F, FieldList<G, Rest...>> {
  static constexpr int value = 1 + IndexOf<F, FieldList<Rest...>>::value;
};

template <class F> inline constexpr int field_index = IndexOf<F, AllFields>::value;

template <class F, class List> inline constexpr bool is_among = false;
template <class F, class... G> inline constexpr bool is_among<F, FieldList<G...>> = (std::is_same_v<F, G> || ...);

template <class A, class B> struct Joined;
template <class... A> struct Joined<FieldList<A...>, FieldList<>> { using type = FieldList<A...>; };
template <class... A, class F, class... B> struct Joined<FieldList<A...>, FieldList<F, B...>> {
  using type = typename std::conditional_t<is_among<F, FieldList<A...>>, Joined<FieldList<A...>, FieldList<B...>>,
                                           Joined<FieldList<A..., F>, FieldList<B...>>>::type;
};

/// The fields of all lists, each once.
template <class... Lists> struct UnionOf { using type = FieldList<>; };
template <class List, class... Lists> struct UnionOf<List, Lists...> {
  using type = typename Joined<List, typename UnionOf<Lists...>::type>::type;
};

template <class A, class B> inline constexpr bool disjoint = true;
template <class... A, class B> inline constexpr bool disjoint<FieldList<A...>, B> = !(is_among<A, B> || ...);

// ---- shapes ---------------------------------------------------------------------------------------------------------

/// Components of a symmetric tensor of a rank, which are the products of so many components of a vector.
constexpr int monomial_count(int dim, int rank) {
  int count = 1;
  for (int k = 1; k <= rank; ++k) count = count * (dim + k - 1) / k;
  return count;
}

template <class F, int Dim> inline constexpr int components = monomial_count(Dim, static_cast<int>(F::shape));

template <class List, int Dim> inline constexpr int total_components = 0;
template <class... F, int Dim>
inline constexpr int total_components<FieldList<F...>, Dim> = (0 + ... + components<F, Dim>);

template <class F, class Real>
using stored_t = std::conditional_t<F::storage == Storage::real, Real,
                                    std::conditional_t<F::storage == Storage::exact, double, std::int64_t>>;

/// A field's value for one particle (T = Real) or for a lane bundle (T = Lanes).
template <class F, int Dim, class T>
using value_t = std::conditional_t<
    F::shape == FieldShape::scalar, T,
    std::conditional_t<F::shape == FieldShape::tensor, SymTensor<Dim, T>, Vec<components<F, Dim>, T>>>;

/// Component k of a value of any shape.
template <class T> T& component(T& v, int) requires(!requires { v.c; }) { return v; }
template <class V> auto& component(V& v, int k) requires(requires { v.c; }) { return v.c[k]; }

}  // namespace molten
