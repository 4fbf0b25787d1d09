# SPDX-License-Identifier: GPL-3.0-or-later
"""How sweeps scale: runs per second by threads of one process, and by MPI ranks if MPI is available.

    bench/scaling.py EOMGEN [RUNS [REPEATS]]

One model (S5_double_pendulum, 10 s, dop853, rtol 1e-9, `--ensemble`), a table of its runs. Wall time of whole commands; what a command takes before and after its runs (derivation, code from the cache, writing) is measured with
a hundredth of them and taken off. Medians, the kinds in turn. eomgen-mpi is looked for beside EOMGEN; its first rank makes no runs and is not counted.
"""
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

MODEL = pathlib.Path(__file__).resolve().parent.parent / "models" / "S5_double_pendulum.toml"


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown processor"


def seconds_of(command, jobs, runs, folder):
    table = folder / "table.csv"
    table.unlink(missing_ok=True)
    begin = time.monotonic()
    subprocess.run(
        [*command, "sweep", MODEL, "--sample", "L1=0.8:1.2", "--samples", str(runs), "--t-end", "10", "--rtol", "1e-9",
         "--solver", "dop853", "--ensemble", *jobs, "--out", table], check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - begin


def main():
    if not 2 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    eomgen = pathlib.Path(sys.argv[1]).resolve()
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else 100_000
    repeats = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    counts = [n for n in (1, 2, 4, 8, 16, 32, 64, 128) if n <= len(os.sched_getaffinity(0))]
    kinds = [("threads", n, [eomgen], ["--jobs", str(n)]) for n in counts]
    with_mpi, mpirun = eomgen.with_name("eomgen-mpi"), shutil.which("mpirun")
    if with_mpi.exists() and mpirun:
        ranks = [mpirun, "--oversubscribe"] + (["--allow-run-as-root"] if os.geteuid() == 0 else [])
        kinds += [("ranks", n, [*ranks, "-n", str(n + 1), with_mpi], ["--jobs", "1"]) for n in counts]
    else:
        print("no ranks: there is no eomgen-mpi beside the program, or no mpirun")
    found = {(kind, n): [] for kind, n, _, _ in kinds}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for repeat in range(repeats + 1):  # the first one compiles
            for kind, n, command, jobs in kinds:
                took = seconds_of(command, jobs, runs, folder) - seconds_of(command, jobs, runs // 100, folder)
                if repeat > 0:
                    found[kind, n].append(0.99 * runs / took)
    print(f"{processor()}; load {os.getloadavg()[0]:.1f}; {runs} runs, medians of {repeats}\n")
    print("| | runs per second | of one, times |\n|---|---|---|")
    for (kind, n), rates in found.items():
        rate, one = statistics.median(rates), statistics.median(found[kind, 1])
        print(f"| {n} {kind if n > 1 else kind[:-1]} | {rate:.0f} | {rate / one:.2f} |")


if __name__ == "__main__":
    main()
