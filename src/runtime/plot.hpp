// The picture of a run, drawn by the Python package fmbpc.plots.
#pragma once

#include <string>
#include <vector>

namespace fpc {

struct PlotResult {
  std::string picture;  ///< file, empty if none was drawn
  std::string warning;  ///< why not, in words
};

inline constexpr char kPython[] = "/usr/bin/python3";
/// PYTHONPATH of our scripts: the folder of the Python package `fmbpc` first. Empty if it is not
/// there.
std::string pythonPath();
/// A script of ours: it stands beside the config folders, in the source tree as in an installed
/// package. Empty if it is not there.
std::string findScript(const std::string& name);

/// Draws plot.png in a folder written by writeRun(). A missing package or matplotlib is a warning,
/// never a failure.
PlotResult drawPlot(const std::string& folder);
/// Runs that were written to these folders, in one picture.
PlotResult drawComparison(const std::vector<std::string>& folders, const std::string& file);
/// bifurcation.png and root_locus.png in a folder with a stability.json.
PlotResult drawStability(const std::string& folder);
/// convergence.png in a folder with a tuning.json or compare.json.
PlotResult drawTuning(const std::string& folder);
/// test.png and model.png in a folder of a commissioning whose plant was watched.
PlotResult drawCommissioning(const std::string& folder);
/// distributions.png in a folder with a study.json.
PlotResult drawStudy(const std::string& folder);

/// The same for a folder that `fmbpc identify --plots` fills; several pictures, none is named.
PlotResult drawModelPlots(const std::string& folder);

/// The same for a folder that `fmbpc reproduce --plots` fills.
PlotResult drawReproduction(const std::string& folder);

}  // namespace fpc
