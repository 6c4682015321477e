#pragma once
#include <string>
#include <vector>

#include "case/case.hpp"

namespace ejecta {

/// One word of a choice, as it stands in the case file, with its line of help.
struct Word {
  std::string name, help;
};

/// The words of each enum, in the order of its enumerators.
const std::vector<Word>& words(FlowSolver);
const std::vector<Word>& words(TurbulenceModel);
const std::vector<Word>& words(Geometry);
const std::vector<Word>& words(BoundaryType);
const std::vector<Word>& words(JetKind);
const std::vector<Word>& words(ValveShape);
const std::vector<Word>& words(ShapeKind);
const std::vector<Word>& words(Motion);
const std::vector<Word>& words(ContactLaw);
const std::vector<Word>& words(WallKind);
const std::vector<Word>& words(RunUntil);
const std::vector<Word>& words(StudyDesign);
const std::vector<Word>& words(MapLying);
const std::vector<Word>& words(CampaignKind);
const std::vector<Word>& words(Presentation);
const std::vector<Word>& words(ParticleForm);
const std::vector<Word>& words(SizeLaw);
const std::vector<Word>& words(WindowRule);
const std::vector<Word>& words(GrainPacking);
const std::vector<Word>& words(GrainDragLaw);
const std::vector<Word>& words(GrainExchange);

/// The word of an enumerator, e.g. "k-omega-sst".
template <class E>
const std::string& word(E e) {
  return words(e)[static_cast<std::size_t>(e)].name;
}

}  // namespace ejecta
