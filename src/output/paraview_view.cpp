#include "output/paraview_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.hpp"
#include "output/run_directory.hpp"

namespace ejecta::output {
namespace {

constexpr const char* kView = R"py(
from paraview.simple import *

view = GetActiveViewOrCreate("RenderView")
view.Background = [0.07, 0.09, 0.12]
view.UseColorPaletteForBackground = 0
readers = {name: PVDReader(registrationName=name, FileName=f"{fields}/{name}.pvd") for name in series}
times = sorted({t for reader in readers.values() for t in (reader.TimestepValues or [0.0])})

# The air: the slices that were recorded, else the middle of the box.
shown = [reader for name, reader in readers.items() if name.startswith("slice-")]
if not shown and "air" in readers:
    readers["air"].UpdatePipeline(times[0])
    box = readers["air"].GetDataInformation().GetBounds()
    cut = Slice(registrationName="middle", Input=readers["air"], SliceType="Plane")
    cut.SliceType.Origin = [(box[2 * d] + box[2 * d + 1]) / 2 for d in range(3)]
    cut.SliceType.Normal = [0, 1, 0]
    shown = [cut]


def fastest(time):
    speed = 0.0
    for source in shown:
        source.UpdatePipeline(time)
        velocity = source.GetDataInformation().GetCellDataInformation().GetArrayInformation("velocity")
        if velocity:
            speed = max(speed, velocity.GetComponentRange(-1)[1])
    return speed


speeds = [fastest(time) for time in times]
moment = times[speeds.index(max(speeds))]
for source in shown:
    display = Show(source, view)
    display.Representation = "Surface"
    ColorBy(display, ("CELLS", "velocity", "Magnitude"))
    display.SetScalarBarVisibility(view, source is shown[0])
if shown:
    colours = GetColorTransferFunction("velocity")
    colours.ApplyPreset("Viridis (matplotlib)", True)
    colours.RescaleTransferFunction(0.0, max(speeds) or 1.0)
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = "air speed", "m/s"

if "bodies" in readers:
    bodies = Show(readers["bodies"], view)
    bodies.Representation = "Surface"
    bodies.ColorArrayName = ["CELLS", ""]
    bodies.DiffuseColor = bodies.AmbientColor = [0.95, 0.7, 0.38]

# From the side: x to the right, z up.
scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.AnimationTime = view.ViewTime = moment
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0, -1, 0], [0, 0, 0], [0, 0, 1]
view.CameraParallelProjection = 1
ResetCamera(view)
Render(view)
if sys.argv[-1].endswith(".png"):
    SaveScreenshot(sys.argv[-1], view, ImageResolution=[1200, 900])
)py";

}  // namespace

std::string paraview_view(const std::filesystem::path& run) {
  const std::filesystem::path fields = std::filesystem::absolute(RunDirectory::open(run).fields());
  std::vector<std::string> series;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(fields, none))
    if (entry.path().extension() == ".pvd") series.push_back(entry.path().stem().string());
  std::sort(series.begin(), series.end());
  if (series.empty())
    throw InputError(
        fmt::format("{} has no fields to look at\n  expected: a run with output.fields_interval or "
                    "output.slices_interval\n  example:  --set output.fields_interval=\"1 ms\"",
                    run.string()));
  return fmt::format(
             "# A view of a run for ParaView 5.11 or newer, written by `ejecta paraview`.\n"
             "#   paraview --script=view.py        (or File, Load State)\n"
             "#   pvpython --force-offscreen-rendering view.py picture.png\n"
             "import sys\n\nfields = {}\nseries = {}\n",
             nlohmann::json(fields.lexically_normal().string()).dump(), nlohmann::json(series).dump()) +
         kView;
}

}  // namespace ejecta::output
