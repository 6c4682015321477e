#include "simulation/archive.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "case/load.hpp"
#include "case/write.hpp"
#include "output/output_file.hpp"
#include "simulation/case_changes.hpp"

namespace ejecta {
namespace {

[[noreturn]] void refuse_running(const std::filesystem::path& directory) {
  throw InputError(
      fmt::format("a run goes on in {}: wait for its end, stop it, or choose another place with --out DIR",
                  directory.string()));
}

std::filesystem::path existing(const std::filesystem::path& directory) {
  std::error_code told_later;
  std::filesystem::create_directories(directory, told_later);
  return directory;
}

output::RunDirectory opened(const RunFiles& files, const DirectoryClaim& claim) {
  if (!claim.held()) refuse_running(files.directory);
  if (files.resume) return output::RunDirectory::open(files.directory);
  return output::RunDirectory::create(files.directory, files.overwrite);
}

std::string place_of(const NamedField& field) { return "field/" + field.name; }
std::string place_of(const std::string& numbers) { return "numbers/" + numbers; }

}  // namespace

std::string input_of(const Case& c) { return write_case(with_absolute_files(c)); }

void Archive::require_place(const RunFiles& files) {
  if (is_claimed(files.directory)) refuse_running(files.directory);
  if (files.resume) output::RunDirectory::open(files.directory);
  else output::RunDirectory::require_creatable(files.directory, files.overwrite);
}

Archive::Archive(const Case& c, Model& model, const RunFiles& files, const OutputsMaker& make_outputs,
                 const Note& note)
    : files_(files),
      claim_(existing(files.directory)),
      directory_(opened(files, claim_)),
      store_(directory_.checkpoints()) {
  const output::Provenance provenance{.command = files.command,
                                      .case_path = c.path,
                                      .input = input_of(c),
                                      .threads = thread_count(),
                                      .overrides = files.overrides,
                                      .files = files_of(c)};
  std::optional<double> resumed;
  if (files.resume) {
    refuse_another_case(provenance.input);
    refuse_changed_files(provenance.files);
    resumed = find_checkpoint(note);
    restore_model(model);  // before anything is cut off what the run has written
  }
  // First of all what says that this is a run: killed here, it is not in the way of the next.
  if (!files.resume) directory_.write_manifest(output::make_manifest(provenance));
  directory_.write_case(provenance.input);
  outputs_ = make_outputs({directory_, output::provenance_lines(provenance), resumed});
}

void Archive::write_checkpoint(Model& model, const Clock& clock, double wall_time) const {
  output::CheckpointWriter w = store_.begin({clock.time(), clock.steps()});
  for (const NamedField& f : model.state_fields())
    w.put(place_of(f), std::span<const Real>(f.field->data(), f.field->size()));
  for (const auto& [name, numbers] : model.state_numbers())
    w.put(place_of(name), std::span<const double>(numbers));
  w.put("outputs", std::span<const double>(outputs_->state()));
  w.put("wall_time", std::span<const double>(&wall_time, 1));
  store_.commit(w);
}

void Archive::restore(Clock& clock, double& wall_time) {
  outputs_->restore(reader_->numbers("outputs"));
  reader_->get("wall_time", std::span<double>(&wall_time, 1));
  clock.restore(reader_->at().time, reader_->at().step);
  reader_.reset();
  directory_.remove_result();
}

void Archive::refuse_another_case(const std::string& input) const {
  const std::string path = files_.directory.string();
  const std::vector<std::string> changed =
      changed_keys(output::read_file(files_.directory / "case.toml"), input);
  if (changed.empty()) return;
  throw InputError(fmt::format(
      "{} was started with another case: {} changed\n  go on as it was:  ejecta run {} --out {} --resume\n"
      "  start anew:       {} --force",
      path, joined(changed), (files_.directory / "case.toml").string(), path, files_.here));
}

/// Meshes and traces are not copied into the run: one that has changed since would go on as another.
void Archive::refuse_changed_files(const std::vector<std::string>& files) const {
  const auto manifest =
      nlohmann::json::parse(output::read_file(files_.directory / "manifest.json"), nullptr, false);
  if (!manifest.is_object() || !manifest.contains("files")) return;
  const auto& before = manifest["files"];
  const auto now = output::digests_of(files);
  for (const auto& [file, digest] : now.items())
    if (before.contains(file) && before[file] != digest)
      throw InputError(fmt::format("{} has changed since {} was started\n  start anew:  {} --force", file,
                                   files_.directory.string(), files_.here));
}

double Archive::find_checkpoint(const Note& note) {
  auto newest = store_.newest();
  for (const std::string& damage : newest.damaged)
    if (note) note("warning: " + damage);
  if (!newest.reader)
    throw InputError(fmt::format("{} holds no checkpoint to resume from; start anew with --force",
                                 files_.directory.string()));
  reader_.emplace(std::move(*newest.reader));
  return reader_->at().time;
}

/// A sealed checkpoint that does not fit is one of another version of the program.
void Archive::restore_model(Model& model) const {
  try {
    for (const NamedField& f : model.state_fields())
      reader_->get(place_of(f), std::span<Real>(f.field->data(), f.field->size()));
    StateNumbers numbers;
    for (const auto& [name, unused] : model.state_numbers()) numbers[name] = reader_->numbers(place_of(name));
    model.restore_numbers(numbers, reader_->at().time);
  } catch (const Error& e) {
    throw InputError(fmt::format("{} cannot be resumed: {}\n  start anew:  {} --force",
                                 files_.directory.string(), e.what(), files_.here));
  }
}

}  // namespace ejecta
