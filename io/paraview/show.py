"""Opens the results of isorim in ParaView: exact shape, edges, fields, probes and grids, in one state.

    pvpython show.py FOLDER [-o VIEWS] [--field NAME] [--component C] [--warp SCALE]

FOLDER is an output folder of `isorim run` (out/<case>). Writes into VIEWS (FOLDER if absent) the pictures
view_iso.png, view_front.png, view_top.png and view_left.png, and state.pvsm, which ParaView opens by
File > Load State. In the program itself: Tools > Python Shell > Run Script, with FOLDER as the current folder.

Bézier cells are drawn with nonlinear subdivision 4, which ParaView leaves at 1 (flat facets between corners).
"""

import argparse
import os
import sys

import paraview.simple as pv

VIEWS = {
    "iso": ((1.0, -1.0, 1.0), (0.0, 0.0, 1.0)),
    "front": ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    "top": ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    "left": ((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", default=".", help="output folder of isorim run")
    parser.add_argument("-o", "--output", help="folder for pictures and state; FOLDER if absent")
    parser.add_argument("--field", help="point field that colours show")
    parser.add_argument("--component", help="xx, yy, ..., X, Y, Z, or Magnitude")
    parser.add_argument("--warp", type=float, help="draws displacements with this factor")
    return parser.parse_args()


def fields_of(source):
    """Names of the point fields, and number of their components."""
    information = source.GetPointDataInformation()
    return {information.GetArray(i).GetName(): information.GetArray(i).GetNumberOfComponents()
            for i in range(information.GetNumberOfArrays())}


def require_component(source, field, component):
    array = source.GetPointDataInformation().GetArray(field)
    known = ["Magnitude"] + [array.GetComponentName(i) for i in range(array.GetNumberOfComponents())]
    if component is not None and component not in known:
        sys.exit(f"show.py: {field} has no component {component!r}; expected one of {', '.join(known)}")


def range_of(source, field, component):
    array = source.GetPointDataInformation().GetArray(field)
    count = array.GetNumberOfComponents()
    names = [array.GetComponentName(i) for i in range(count)]
    return array.GetRange(names.index(component) if component in names else 0 if count == 1 else -1)


def open_files(folder):
    """The sources by file name, of what is there."""
    sources = {}
    names = ["solution.vtu", "fields.vtu", "boundary.vtu", "edges.vtu"]
    names += sorted(name for name in os.listdir(folder)
                    if name.startswith(("grid_", "probe_")) and name.endswith((".vti", ".vtp")))
    for name in names:
        path = os.path.join(folder, name)
        if os.path.exists(path):
            sources[name] = pv.OpenDataFile(path)
            sources[name].UpdatePipeline()
            pv.RenameSource(name, sources[name])
    return sources


def choose_shape(sources, field):
    """The file that draws the boundary: exact cells if they have the field, else the facets with all fields."""
    for name in ("solution.vtu", "fields.vtu", "boundary.vtu"):
        if name in sources and (field is None or field in fields_of(sources[name])):
            return name
    known = sorted({known for source in sources.values() for known in fields_of(source)} - {"RationalWeights"})
    sys.exit(f"show.py: found no field {field!r}; expected one of {', '.join(known)}" if known else
             "show.py: found no boundary.vtu here; expected an output folder of isorim run")


class Scene:
    """A view, and the ranges of the field in what is shown."""

    def __init__(self, view, options):
        self.view = view
        self.options = options
        self.ranges = []

    def show(self, source, width=1.0):
        display = pv.Show(source, self.view)
        display.SetRepresentationType("Surface")
        display.LineWidth = width
        display.PointSize = 8.0
        if hasattr(display, "NonlinearSubdivisionLevel"):
            display.NonlinearSubdivisionLevel = 4
        field, component = self.options.field, self.options.component
        if field is None or field not in fields_of(source):
            display.ColorArrayName = ["POINTS", ""]
            return display
        require_component(source, field, component)
        self.ranges.append(range_of(source, field, component))
        pv.ColorBy(display, ("POINTS", field, component) if component else ("POINTS", field))
        display.SetScalarBarVisibility(self.view, True)
        return display

    def finish_colours(self):
        if not self.ranges:
            return
        colours = pv.GetColorTransferFunction(self.options.field)
        colours.ApplyPreset("Viridis (matplotlib)", True)
        colours.RescaleTransferFunction(min(low for low, _ in self.ranges), max(high for _, high in self.ranges))
        bar = pv.GetScalarBar(colours, self.view)
        bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]

    def show_all(self, sources):
        boundary = sources[choose_shape(sources, self.options.field)]
        if self.options.warp is not None and "displacement" in fields_of(boundary):
            boundary = pv.WarpByVector(Input=boundary, Vectors=["POINTS", "displacement"],
                                       ScaleFactor=self.options.warp)
        self.show(boundary, 4.0)
        if "edges.vtu" in sources and self.options.warp is None:
            edges = self.show(sources["edges.vtu"], 2.0)
            edges.AmbientColor = edges.DiffuseColor = [0.1, 0.1, 0.1]
        for name, source in sources.items():
            if name.startswith(("grid_", "probe_")):
                self.show(source)
        self.finish_colours()


def look_from(view, name):
    direction, up = VIEWS[name]
    view.CameraFocalPoint = [0.0, 0.0, 0.0]
    view.CameraPosition = list(direction)
    view.CameraViewUp = list(up)
    view.ResetCamera(False)


def main():
    options = arguments()
    if not os.path.isdir(options.folder):
        sys.exit(f"show.py: there is no folder {options.folder}")
    output = options.output or options.folder
    os.makedirs(output, exist_ok=True)
    view = pv.GetActiveViewOrCreate("RenderView")
    view.ViewSize = [1200, 900]
    view.CameraParallelProjection = 1
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    Scene(view, options).show_all(open_files(options.folder))
    for name in VIEWS:
        look_from(view, name)
        pv.SaveScreenshot(os.path.join(output, f"view_{name}.png"), view, ImageResolution=[1200, 900])
    look_from(view, "iso")
    pv.SaveState(os.path.join(output, "state.pvsm"))


if __name__ == "__main__":
    main()
