#include "case/schema.hpp"
#include "case/size_law.hpp"

/// Grains smaller than a cell, and how the fluid drags them.
namespace ejecta {

using enum Dimension;

std::vector<Key> keys(GrainsSpec& s) {
  std::vector<Key> list{{.name = "name",
                         .slot = &s.name,
                         .help = "Name in results",
                         .unset = "grains-1, grains-2, ...",
                         .example = "\"dust\""},
                        {.name = "material",
                         .slot = &s.material,
                         .help = "Name of a [[material]]",
                         .unset = "the first [[material]], or one with the defaults",
                         .example = "\"quartz\""},
                        {"density", &s.density, density, positive, "Density", "", "the material's"}};
  append_size_keys(list, s, "Diameter; of \"uniform\" the smallest, of \"lognormal\" the median",
                   {"\"0.5 mm\"", "\"1 mm\""});
  list.insert(list.end(),
              {{"count",
                &s.count,
                none,
                {0, 10'000'000},
                "How many",
                "",
                "by `mass` or `solids_fraction`",
                false,
                "10000"},
               {"mass", &s.mass, mass, positive, "How many, by their mass", "",
                "by `count` or `solids_fraction`", false, "\"10 g\""},
               {"solids_fraction",
                &s.solids_fraction,
                none,
                {0.0, 0.7405, true},
                "How many, by their part of the region's volume; close packing is 0.74",
                "Hales 2005",
                "by `count` or `mass`",
                false,
                "0.01"},
               {.name = "region",
                .slot = &s.region,
                .dimension = length,
                .help = "Lower and upper corner of where they start; grains lie wholly inside",
                .unset = "the whole box of the grid",
                .example = R"([["0 mm", "0 mm", "0 mm"], ["10 mm", "10 mm", "5 mm"]])"},
               {"packing", choice(s.packing), none, anything, "How they lie there", ""},
               {"velocity", &s.velocity, velocity, anything, "Velocity at the start", ""},
               {"held", &s.held, none, anything, "They stay where they are: a fixed bed", ""},
               {"from", &s.from, time, not_negative, "They are not there before", ""},
               {"over", &s.over, time, not_negative,
                "They come one after the other, evenly over this time after `from`; 0: together", ""},
               {"seed", &s.seed, none, not_negative, "Of places and sizes", ""}});
  return list;
}

std::vector<Key> keys(CouplingSpec& s) {
  return {
      {"drag", choice(s.drag), none, anything, "Drag of the fluid on a grain", "paper 2.2.3"},
      {"exchange", choice(s.exchange), none, anything, "Who acts on whom", "paper 2.2.3"},
      {"kernel_width",
       &s.kernel_width,
       none,
       {1.0, 20.0},
       "Width over which a grain is spread and sees the fluid, in its diameters; never less than two cells",
       "2 to 3 diameters are usual"},
      {"dispersion", &s.dispersion, none, anything,
       "Turbulence spreads grains: each meets eddies with a velocity of their own, drawn at random",
       "Gosman & Ioannides 1983"}};
}

}  // namespace ejecta
