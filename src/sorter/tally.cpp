#include "sorter/tally.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"

namespace ejecta {

const char* word(Fate fate) {
  static constexpr std::array<const char*, kFates> words{"ejected",
                                                         "kept",
                                                         "missed_not_seen",
                                                         "missed_misread",
                                                         "missed_agglomerated",
                                                         "missed_dead_valve",
                                                         "missed_late",
                                                         "missed_pushed",
                                                         "missed_struck_plate",
                                                         "missed_too_weak",
                                                         "taken_pushed",
                                                         "taken_in_window",
                                                         "taken_misread",
                                                         "taken_agglomerated"};
  return words[static_cast<std::size_t>(fate)];
}

double Tally::number(std::size_t kind) const {
  return std::accumulate(kinds[kind].number.begin(), kinds[kind].number.end(), 0.0);
}
double Tally::mass(std::size_t kind) const {
  return std::accumulate(kinds[kind].mass.begin(), kinds[kind].mass.end(), 0.0);
}

void Tally::add(const Tally& other) {
  std::vector<double> mine = values();
  const std::vector<double> more = other.values();
  if (kinds.empty()) {
    *this = other;
    return;
  }
  for (std::size_t n = 0; n < mine.size(); ++n) mine[n] += more[n];
  *this = of_values(mine, kinds.size());
}

std::vector<double> Tally::values() const {
  std::vector<double> v{length, objects, shots, openings, air, cut};
  for (const Kind& k : kinds) {
    v.insert(v.end(), k.number.begin(), k.number.end());
    v.insert(v.end(), k.mass.begin(), k.mass.end());
    v.insert(v.end(), {k.alone, k.alone_seen, k.area, k.slipping, k.met, k.in_another, k.late_squares});
  }
  return v;
}

Tally Tally::of_values(const std::vector<double>& values, std::size_t kinds) {
  constexpr std::size_t kOfAll = 6, kOfKind = 2 * kFates + 7;
  if (values.size() != kOfAll + kinds * kOfKind)
    throw InputError(
        "the sums kept there are those of another version of the program\n  expected: --force, to start "
        "anew");
  Tally t;
  auto at = values.begin();
  for (double* one : {&t.length, &t.objects, &t.shots, &t.openings, &t.air, &t.cut}) *one = *at++;
  for (std::size_t k = 0; k < kinds; ++k) {
    Kind kind;
    for (double& n : kind.number) n = *at++;
    for (double& m : kind.mass) m = *at++;
    for (double* one : {&kind.alone, &kind.alone_seen, &kind.area, &kind.slipping, &kind.met,
                        &kind.in_another, &kind.late_squares})
      *one = *at++;
    t.kinds.push_back(kind);
  }
  return t;
}

void ShareSums::add(double part, double whole, double particles) {
  a += part;
  b += whole;
  aa += part * part;
  ab += part * whole;
  bb += whole * whole;
  pieces += 1.0;
  count += particles;
}

namespace {

/// Fewer pieces do not know their own scatter well: it is then at least that of independent particles.
constexpr double kManyPieces = 30.0;

/// Within so many standard deviations lie 95 % of Student's distribution; above four degrees of freedom by
/// its expansion about the normal one (Abramowitz & Stegun 1964, 26.7.5).
double student(double freedom) {
  constexpr std::array<double, 5> few{0.0, 12.706, 4.303, 3.182, 2.776};
  if (freedom < 5.0) return few[static_cast<std::size_t>(freedom)];
  constexpr double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z, z7 = z5 * z * z;
  return z + (z3 + z) / (4.0 * freedom) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * freedom * freedom) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * freedom * freedom * freedom);
}

}  // namespace

Share ShareSums::share() const {
  if (!(b > 0.0)) return {};
  Share s{.value = a / b, .known = true};
  if (pieces < 2.0) return s;  // one tells nothing of the scatter: anything from 0 to 1
  // The variance of a ratio of sums over pieces (Cochran 1977, 6.3).
  const double r = s.value, scatter = aa - 2.0 * r * ab + r * r * bb;
  const double variance = std::max(scatter, 0.0) / (b * b) * pieces / (pieces - 1.0);
  const double spread = r * (1.0 - r);
  double independent = variance > 1e-300 && spread > 1e-12 ? spread / variance : count;
  if (pieces < kManyPieces) independent = std::min(independent, count);
  const double z = student(pieces - 1.0);
  const double n = std::max(independent, 1.0), middle = (r + z * z / (2 * n)) / (1 + z * z / n),
               half = z / (1 + z * z / n) * std::sqrt(std::max(spread, 0.0) / n + z * z / (4 * n * n));
  s.low = std::max(0.0, middle - half);
  s.high = std::min(1.0, middle + half);
  return s;
}

void Products::add(const Tally& piece, const std::vector<ParticleClassSpec>& classes) {
  total.add(piece);
  double wanted[2] = {0, 0}, wanted_ejected[2] = {0, 0}, others[2] = {0, 0}, others_ejected[2] = {0, 0};
  double count = 0.0, single = 0.0, seen = 0.0, ejected_count = 0.0;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    const Tally::Kind& kind = piece.kinds[k];
    const bool eject = classes[k].eject;
    for (std::size_t f = 0; f < kFates; ++f) {
      const double amount[2] = {kind.number[f], kind.mass[f]};
      for (int by = 0; by < 2; ++by) {
        (eject ? wanted : others)[by] += amount[by];
        if (goes_to_ejects(static_cast<Fate>(f))) (eject ? wanted_ejected : others_ejected)[by] += amount[by];
      }
      count += kind.number[f];
      if (goes_to_ejects(static_cast<Fate>(f))) ejected_count += kind.number[f];
    }
    single += kind.alone;
    seen += kind.alone_seen;
  }
  for (int by = 0; by < 2; ++by) {
    const std::size_t first = by == 0 ? recovery : recovery_mass;
    sums[first].add(wanted_ejected[by], wanted[by], wanted[0]);
    sums[first + 1].add(wanted_ejected[by], wanted_ejected[by] + others_ejected[by], ejected_count);
    sums[first + 2].add(others_ejected[by], others[by], others[0]);
  }
  sums[yield_mass].add(wanted_ejected[1] + others_ejected[1], wanted[1] + others[1], count);
  sums[alone].add(single, count, count);
  sums[alone_seen].add(seen, count, count);
}

}  // namespace ejecta
