# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Makes a ParaView state file for the points of dump mpm/vtk, which opens with the scene as it should look.

   pvpython tools/paraview_state.py bar.pvd [--color eplastic] [--range MIN MAX] [--diameter D] [--view X Y Z]
                                    [--picture bar.png]

It writes bar.pvsm beside bar.pvd: ParaView's File > Load State opens it, with the points as spheres (Point Gaussian) of
the size of what they stand for, colored by a field (a vector or tensor by its magnitude), a color bar, the time, and
orthographic projection. --diameter: of the spheres; as a rule 1.3 times the usual distance of neighbors in the first snapshot.
--view: direction from which the camera looks. --picture: of the last snapshot, too. pvpython comes with ParaView, 5.11 or
later; without a screen run it under xvfb-run.
"""

import argparse
import os

import numpy as np
from paraview import servermanager, simple
from vtk.util.numpy_support import vtk_to_numpy

from picture import usual_distance


def positions(reader):
    return vtk_to_numpy(servermanager.Fetch(reader).GetPoints().GetData()).astype(float)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("list", help="the .pvd file of the dump")
    parser.add_argument("--color", default="type", help="field, default: type")
    parser.add_argument("--range", nargs=2, type=float, metavar=("MIN", "MAX"),
                        help="of colors, default: that of all snapshots")
    parser.add_argument("--diameter", type=float)
    parser.add_argument("--view", nargs=3, type=float, default=(0.5, 1.0, -0.4), metavar=("X", "Y", "Z"))
    parser.add_argument("--picture", help="PNG of the last snapshot")
    args = parser.parse_args()

    reader = simple.PVDReader(FileName=os.path.abspath(args.list))
    reader.UpdatePipelineInformation()
    times = list(reader.TimestepValues)
    if not times:
        raise SystemExit("%s: no snapshots" % args.list)
    simple.UpdatePipeline(times[0], reader)
    fields = reader.PointData.keys()
    if args.color not in fields:
        raise SystemExit("no field %s in %s: it has %s" % (args.color, args.list, " ".join(fields)))

    view = simple.GetActiveViewOrCreate("RenderView")
    view.ViewSize = [1280, 960]
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesLabelColor = view.OrientationAxesOutlineColor = [0, 0, 0]
    points = simple.Show(reader, view)
    points.SetRepresentationType("Point Gaussian")
    points.GaussianRadius = 0.5 * (args.diameter or 1.3 * usual_distance(positions(reader)))
    points.ShaderPreset = "Sphere"
    simple.ColorBy(points, ("POINTS", args.color))
    colors = simple.GetColorTransferFunction(args.color)
    if args.range:
        colors.RescaleTransferFunction(*args.range)
    else:
        points.RescaleTransferFunctionToDataRangeOverTime()
    points.SetScalarBarVisibility(view, True)
    bar = simple.GetScalarBar(colors, view)
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    time = simple.Show(simple.AnnotateTimeFilter(reader, Format="time {time:.4g}"), view)
    time.Color = [0, 0, 0]

    flat = reader.GetDataInformation().GetBounds()
    direction = np.array((0.0, 0.0, -1.0) if flat[4] == flat[5] else args.view)
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraPosition = list(-direction)
    view.CameraViewUp = [0, 1, 0] if abs(direction[2]) > 0.99 * np.linalg.norm(direction) else [0, 0, 1]
    view.ViewTime = times[-1]
    simple.GetAnimationScene().AnimationTime = times[-1]
    simple.Render(view)
    simple.ResetCamera(view)

    state = os.path.splitext(args.list)[0] + ".pvsm"
    simple.SaveState(state)
    print(state)
    if args.picture:
        simple.SaveScreenshot(args.picture, view)
        print(args.picture)


if __name__ == "__main__":
    main()
