"""Scenarios of script/faults by name."""

from robustness import conversions, fits, python_module, robots, scenarios

ALL = {"run": scenarios.Run, "learn": scenarios.Learn, "view": scenarios.View, "check": scenarios.Check,
       "compare": scenarios.Compare, "report": scenarios.Report, "top": scenarios.Top,
       "import_mjcf": conversions.ImportMjcf, "import_ntrt": conversions.ImportNtrt,
       "export_mjcf": conversions.ExportMjcf, "export_shape": conversions.ExportShape,
       "export_structure": conversions.ExportStructure, "new_robot": conversions.NewRobot,
       "new_mapping": conversions.NewMapping,
       "analyze": conversions.Analyze, "size": conversions.Size,
       "fit": fits.Fit, "fit_resumed": fits.FitResumed,
       "robot_log": robots.Log, "robot_hold": robots.Hold, "robot_calibrate": robots.Calibrate, "robot_run": robots.Run,
       "python_import": python_module.Import, "python_run": python_module.Run, "python_trace": python_module.Trace,
       "python_batch": python_module.Batch, "python_simulation": python_module.Simulation,
       "python_gym": python_module.Environments, "python_learn": python_module.Learn, "python_fit": python_module.Fit}
