# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: docs examples
# timeout: 300
"""What the manual shows works: complete scenes run, and every line under "Examples" is accepted in
a scene that has the groups, regions and variables it speaks of."""

import os
import tempfile

import docs_scenes
import mpm_testing as mt


def run_scene(scene, timeout=60):
    with tempfile.TemporaryDirectory() as folder:
        docs_scenes.write_files(folder, scene)
        return mt.lammps(folder, scene, timeout=timeout)


def test_examples_are_found():
    found = sum(len(docs_scenes.examples(path)) for path in docs_scenes.pages())
    assert found > 25, found


def make_test(path):
    def check():
        wrong = []
        for line, scene in docs_scenes.example_scenes(path):
            result = run_scene(scene)
            if result.code != 0:
                error = [text for text in result.output.splitlines() if text.startswith("ERROR")]
                wrong.append("%s\n    %s" % (line, error[0] if error else result.tail(3)))
        assert not wrong, "\n".join(wrong)
    return check


for _path in docs_scenes.pages():
    if docs_scenes.examples(_path):
        globals()["test_" + os.path.basename(_path)[:-4]] = make_test(_path)


def test_complete_scenes_run():
    mt.long_case()
    scenes = [(path, scene) for path in docs_scenes.pages()
              for scene in docs_scenes.complete_scenes(path)]
    assert scenes, "no complete scene in the manual"
    for path, scene in scenes:
        result = run_scene(scene, timeout=100)
        assert result.code == 0 and "Loop time" in result.output, \
            os.path.basename(path) + "\n" + result.tail()
        assert not mt.warnings(result.output), os.path.basename(path) + "\n" + "\n".join(mt.warnings(result.output))


mt.main(globals())
