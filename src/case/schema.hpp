#pragma once
#include <vector>

#include "case/case.hpp"
#include "case/key.hpp"

namespace ejecta {

/// All sections of the case file, bound to `c`, in the order in which they are read and written. The parser,
/// `ejecta explain`, docs/reference.md, the JSON schema and the templates are made from this and nothing
/// else.
std::vector<Section> sections(Case& c);

inline constexpr std::array<const char*, 6> face_names{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
inline constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

// The keys of each struct.
std::vector<Key> keys(RunSpec&);
std::vector<Key> keys(EnvironmentSpec&);
std::vector<Key> keys(FluidSpec&);
std::vector<Key> keys(FlowSpec&);
std::vector<Key> keys(GridSpec&);
std::vector<Key> keys(AxisSpec&);
/// Pressures of a state are gauge in incompressible flow, absolute otherwise.
std::vector<Key> keys(BoundarySpec&, Dimension pressure);
std::vector<Key> keys(PatchSpec&, Dimension pressure);
std::vector<Key> keys(InitialSpec&, Dimension pressure);
std::vector<Key> keys(ValveSpec&);
std::vector<Key> keys(JetSpec&);
std::vector<Key> keys(MaterialSpec&);
std::vector<Key> keys(MaterialPairSpec&);
std::vector<Key> keys(ContactSpec&);
std::vector<Key> keys(BodySpec&);
std::vector<Key> keys(GrainsSpec&);
std::vector<Key> keys(CouplingSpec&);
std::vector<Key> keys(DomainSpec&);
std::vector<Key> keys(LaunchSpec&);
std::vector<Key> keys(WallSpec&);
std::vector<Key> keys(SplitterSpec&);
std::vector<Key> keys(StreamSpec&);
std::vector<Key> keys(ProbeSpec&);
std::vector<Key> keys(LineSpec&);
std::vector<Key> keys(SliceSpec&);
std::vector<Key> keys(MeasuredSpec&);
std::vector<Key> keys(OutputSpec&);
std::vector<Key> keys(CheckpointSpec&);
std::vector<Key> keys(ExactSpec&, Dimension pressure);
std::vector<Key> keys(ExpectSpec&);
std::vector<Key> keys(ConvergenceSpec&);
std::vector<Key> keys(StudySpec&);
std::vector<Key> keys(VarySpec&);
std::vector<Key> keys(MapSpec&);
std::vector<Key> keys(CampaignSpec&);
std::vector<Key> keys(CampaignPartSpec&);
std::vector<Key> keys(SorterSpec&);
std::vector<Key> keys(FeedSpec&);
std::vector<Key> keys(ParticleClassSpec&);
std::vector<Key> keys(CameraSpec&);
std::vector<Key> keys(ControllerSpec&);
std::vector<Key> keys(ManifoldSpec&);

/// A section that says what is written down, compared or studied, not what happens.
bool changes_no_result(const std::string& section);

}  // namespace ejecta
