#include "case/words.hpp"

namespace ejecta {

const std::vector<Word>& words(FlowSolver) {
  static const std::vector<Word> list{
      {"none", "no fluid: bodies move under gravity and contacts alone"},
      {"incompressible", "PISO (Issa 1986): liquids, and gases below about Mach 0.3"},
      {"compressible", "Godunov, density based: shocks, the under-expanded jet near its nozzle; no bodies"},
      {"compressible-piso",
       "pressure based, any Mach number below about 0.8: steps limited by the flow, not by sound"}};
  return list;
}

const std::vector<Word>& words(TurbulenceModel) {
  static const std::vector<Word> list{
      {"laminar", "no model"},
      {"k-epsilon", "standard k-epsilon with wall functions (Launder & Spalding 1974)"},
      {"k-omega-sst", "k-omega SST (Menter 1994)"}};
  return list;
}

const std::vector<Word>& words(Geometry) {
  static const std::vector<Word> list{
      {"cartesian", "a box in x, y, z; an axis with one cell makes it two-dimensional"},
      {"axisymmetric", "x is the radius, z the axis; y has one cell"}};
  return list;
}

const std::vector<Word>& words(BoundaryType) {
  static const std::vector<Word> list{
      {"velocity", "fixed velocity (and k, epsilon, temperature), zero-gradient pressure"},
      {"total-pressure", "a reservoir that blows in at its total pressure and temperature"},
      {"pressure-outlet", "fixed static pressure, zero-gradient velocity; what flows back in is at rest"},
      {"wave-transmissive", "lets sound out without reflection (compressible)"},
      {"free-stream", "ambient pressure; air may be drawn in or leave"},
      {"wall", "no slip, at rest"},
      {"moving-wall", "no slip at the velocity given"},
      {"slip", "no flow through, no friction"},
      {"symmetry", "mirror plane"},
      {"periodic", "joined with the opposite face"},
      {"jet", "the valve's jet enters here, see [jet] and [valve]; elsewhere as free-stream"}};
  return list;
}

const std::vector<Word>& words(JetKind) {
  static const std::vector<Word> list{
      {"self-similar",
       "round turbulent jet with the momentum of the valve, cut at the height of the boundary"},
      {"velocity-inlet", "uniform velocity through the orifice itself; the box starts at the nozzle"},
      {"computed", "the stored result of another case, the jet from its nozzle"}};
  return list;
}

const std::vector<Word>& words(ValveShape) {
  static const std::vector<Word> list{{"linear", "straight ramps"},
                                      {"smooth", "ramps x^2 (3 - 2 x), without kinks"},
                                      {"exponential", "1 - exp(-3 x): 95 % after the rise time"},
                                      {"trace", "opening read from a CSV file"}};
  return list;
}

const std::vector<Word>& words(ShapeKind) {
  static const std::vector<Word> list{
      {"sphere", "`diameter`"},
      {"box", "cuboid of edge lengths `size`"},
      {"multisphere", "union of `spheres`"},
      {"cluster", "regular pattern of spheres inside `size`, as the paper's 27- and 9-sphere particles"},
      {"polyhedron", "convex hull of `vertices`"},
      {"mesh", "closed surface from the STL `file`"},
      {"superquadric", "`size` and `exponents`"}};
  return list;
}

const std::vector<Word>& words(Motion) {
  static const std::vector<Word> list{
      {"free", "moves under all forces"},
      {"fixed", "stays where it is"},
      {"prescribed", "goes its way by `velocity` and `spin`, or by `path`, whatever acts"}};
  return list;
}

const std::vector<Word>& words(ContactLaw) {
  static const std::vector<Word> list{
      {"hertz-mindlin",
       "Hertz normal force, Mindlin tangential force with history (Johnson 1985, Mindlin 1949)"},
      {"linear", "linear spring and dashpot"}};
  return list;
}

const std::vector<Word>& words(WallKind) {
  static const std::vector<Word> list{
      {"plane", "half space behind `point`, facing `normal`"},
      {"plate", "thin rectangle of extents `size` at `point`, facing `normal`"},
      {"box", "cuboid of edges `size` centred at `point`"},
      {"belt", "plate whose surface runs with `velocity`"},
      {"mesh", "surface from the STL `file`"}};
  return list;
}

const std::vector<Word>& words(RunUntil) {
  static const std::vector<Word> list{
      {"time", "up to end_time"},
      {"verdict", "until every body has passed the splitter, at most end_time"},
      {"rest", "until every body has come to rest, at most end_time"}};
  return list;
}

const std::vector<Word>& words(StudyDesign) {
  static const std::vector<Word> list{
      {"grid", "every value of each key with every value of the others"},
      {"list", "the first values of all keys together, then the second, ..."},
      {"latin-hypercube", "random, each key spread evenly over its range (McKay et al. 1979)"},
      {"sobol", "a sequence that fills all ranges evenly (Joe & Kuo 2008)"}};
  return list;
}

const std::vector<Word>& words(CampaignKind) {
  static const std::vector<Word> list{
      {"run", "`ejecta run`"}, {"jet", "`ejecta jet`"},     {"jet-sweep", "`ejecta jet --sweep`"},
      {"map", "`ejecta map`"}, {"study", "`ejecta study`"}, {"sort", "`ejecta sort`"}};
  return list;
}

const std::vector<Word>& words(MapLying) {
  static const std::vector<Word> list{
      {"given", "as the body is"},
      {"turned", "turned about the vertical by any angle, all alike: as bodies lie on a belt"},
      {"any", "any rotation in space, all alike: as bodies tumble"}};
  return list;
}

const std::vector<Word>& words(Presentation) {
  static const std::vector<Word> list{
      {"independent", "each particle anywhere, whatever lies there (a Poisson process): the worst case"},
      {"monolayer", "anywhere but not on each other"},
      {"feeder",
       "as they come to rest: a monolayer on a tray, over its lip, on the running belt, contacts computed"},
      {"file", "where the CSV `file` says, as a camera logs it"}};
  return list;
}

const std::vector<Word>& words(ParticleForm) {
  static const std::vector<Word> list{
      {"box", "cuboid; with flatness 0.5 the paper's flat particle"},
      {"rock", "random convex rocks"},
      {"sphere", "ball"},
      {"cluster", "the paper's spheres inside a box: 27, or 9 where flatness is 0.5 or less"},
      {"mesh", "closed surface from the STL `file`, scaled to its size"}};
  return list;
}

const std::vector<Word>& words(SizeLaw) {
  static const std::vector<Word> list{
      {"one", "all of one `size`"},
      {"uniform", "by number evenly from `size` to `size_to`"},
      {"lognormal", "by number; median `size`, standard deviation of the logarithm `spread`"},
      {"rosin-rammler", "by mass; 63 % finer than `size`, exponent `spread` (Rosin & Rammler 1933)"},
      {"sieves", "by mass, from the CSV file `sieves`: size and share finer than it"}};
  return list;
}

const std::vector<Word>& words(WindowRule) {
  static const std::vector<Word> list{
      {"fixed", "every command lasts `duration`, as the paper's machine"},
      {"by-size", "as long as the object needs to pass, and the errors of its time beside it"}};
  return list;
}

const std::vector<Word>& words(GrainPacking) {
  static const std::vector<Word> list{
      {"random", "anywhere but not in each other, one after the other: up to 0.3 of the region"},
      {"lattice", "face-centred cubic, as near to each other as their number asks: up to 0.74"}};
  return list;
}

const std::vector<Word>& words(GrainDragLaw) {
  static const std::vector<Word> list{
      {"none", "no drag"},
      {"stokes", "3 pi mu d: linear, for Re far below 1 (Stokes 1851)"},
      {"schiller-naumann", "one grain alone (Schiller & Naumann 1935)"},
      {"di-felice", "grains among others (Di Felice 1994), the paper's"},
      {"rong", "as Di Felice, with the exponent of Rong, Dong & Yu 2013"},
      {"koch-hill", "from lattice-Boltzmann simulations (Koch & Hill 2001)"},
      {"gidaspow", "Ergun below a void fraction of 0.8, Wen & Yu above (Gidaspow 1994)"}};
  return list;
}

const std::vector<Word>& words(GrainExchange) {
  static const std::vector<Word> list{{"two-way", "grains load the fluid and take its room"},
                                      {"one-way", "grains feel the fluid, which does not notice them"}};
  return list;
}

}  // namespace ejecta
