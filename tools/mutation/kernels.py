"""Changes of the kernels for the worse, each of which the tests of their roundings must notice.

A mutation is applied to the kernels' source on its way to the OpenCL compiler (tests/tools/mutate_kernels.cpp); nothing
is rebuilt.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

TESTS = "Roundings.*:*ExactSums.*:*DamagedIndex.*"
LIGHT_TESTS = "SinglePrecision.TurnsEveryCodeIntoItsLight"
STEADY_TESTS = "KeptSumsOf.RandomCases*:KeptSumsOf.BlackIs*"
BLENDING_TESTS = "SoftMasks.KeepTo*:SoftMasks.OfWholeNumbers*:SoftMasks.LeaveOther*"

# Name, what the source has, what it gets instead.
SUM = "  return multiply_add(weights, lights, sums);"
PAIR_SUM = "  return exact_sum(sum.high, sum.low + (a.low + b.low));"
SHARE = "  return NUTIK_TO_REALS(shares) * (real)NUTIK_SHARE_UNIT;"
MUTATIONS = (
    ("floats and doubles: each sum is rounded twice more", SUM,
     "  return multiply_add(weights, lights, sums) * (real)1.1 * (1 / (real)1.1);"),
    ("floats and doubles: each sum is a last place too large", SUM,
     "  return multiply_add(weights, lights, sums) * (1 + (sizeof(real) == 4 ? (real)1.2e-7f : (real)2.3e-16));"),
    ("floats and doubles: each sum is a last place too small", SUM,
     "  return multiply_add(weights, lights, sums) * (1 - (sizeof(real) == 4 ? (real)1.2e-7f : (real)2.3e-16));"),
    ("doubles: weights are cast to float", SUM,
     "  return multiply_add(NUTIK_TO_REALS(NUTIK_CONVERT(float)(weights)), lights, sums);"),
    ("doubles: sums are cast to float", SUM,
     "  return NUTIK_TO_REALS(NUTIK_CONVERT(float)(multiply_add(weights, lights, sums)));"),
    ("pairs: a sum forgets its low part", PAIR_SUM, "  return exact_sum(sum.high, sum.low + b.low);"),
    ("pairs: a sum forgets its term's low part", PAIR_SUM, "  return exact_sum(sum.high, sum.low + a.low);"),
    ("pairs: a sum forgets what high parts leave over", PAIR_SUM, "  return exact_sum(sum.high, a.low + b.low);"),
    ("pairs: low parts are rounded twice more", PAIR_SUM,
     "  return exact_sum(sum.high, (sum.low + (a.low + b.low)) * 1.1f * (1 / 1.1f));"),
    ("pairs: a product forgets its rest", "  product.low = fma(a, b, -product.high);", "  product.low = (reals)(0);"),
    ("pairs: a product of halves forgets one", " + a_lower * b_upper)", ")"),
    ("pairs: a product forgets low parts",
     "  product.low += multiply_add(weights.high, lights.low, weights.low * lights.high);", ""),
    ("whole numbers: a product loses its last bit", "  return sums + weights * lights;",
     "  return sums + (weights * lights >> 1 << 1);"),
    ("whole numbers: a product loses 20 bits", "  return sums + weights * lights;",
     "  return sums + (weights * lights >> 20 << 20);"),
    ("light: each step of the curve is rounded twice more", "    light = multiply_add(light, t, (reals)(coefficients[j]));",
     "    light = multiply_add(light, t, (reals)(coefficients[j])) * 1.1f * (1 / 1.1f);"),
    ("light: each step of the pieces is rounded twice more",
     "    light = multiply_add(light, c, permute(NUTIK_LOAD(coefficients + j * NUTIK_PIECES), piece));",
     "    light = multiply_add(light, c, permute(NUTIK_LOAD(coefficients + j * NUTIK_PIECES), piece)) * 1.1f * "
     "(1 / 1.1f);"),
    ("blending: doubles' shares are cast to float", SHARE,
     "  return NUTIK_TO_REALS(NUTIK_CONVERT(float)(NUTIK_TO_REALS(shares) * (real)NUTIK_SHARE_UNIT));"),
    ("blending: shares are a thousandth too small", SHARE,
     "  return NUTIK_TO_REALS(shares) * (real)(NUTIK_SHARE_UNIT * 0.999f);"),
    ("blending: light below 0 counts as none", "  return sums * first * second;",
     "  return max(sums * first * second, (reals)(0));"),
    ("blending: pairs forget the low part of light",
     "  const Lights light = {sums.high * first * second, sums.low * first * second};",
     "  const Lights light = {sums.high * first * second, (reals)(0)};"),
    ("blending: pairs forget the low part of shares", "  return add_product(unit, whole, zero());",
     "  Pairs share = add_product(unit, whole, zero()); share.low = (reals)(0); return share;"),
    ("blending: whole lights lose 30 bits", "-most, most) << left >> right;",
     "-most, most) << left >> right >> 30 << 30;"),
    ("blending: whole shares are of 65536", "  const Lights light = positive / (Lights)(65535);",
     "  const Lights light = positive >> 16;"),
    ("blending: one function is left out", "    for (size_t tile = first; tile < last; ++tile) {",
     "    for (size_t tile = first; tile + 1 < last; ++tile) {"),
    ("steady: doubles are multiplied by a gain that is cast to float", "{ return gains * sums; }",
     "{ return NUTIK_TO_REALS(NUTIK_CONVERT(float)(gains)) * sums; }"),
    ("steady: pairs forget the low part of what a gain is multiplied to", "{ return add_product(gains, sums, zero()); }",
     "{ Sums high = sums; high.low = (reals)(0); return add_product(gains, high, zero()); }"),
    ("steady: a bundle forgets its last block", "if (adds) load_tile(bundles, tile, lane, sums_of_block);",
     "if (adds) (void)0;"),
    ("steady: sums begin with what comes first", "store_sums(add(is_start ? zero() : load_sums(to), sum), to);",
     "store_sums(is_start ? sum : add(load_sums(to), sum), to);"),
    ("an index of rows is not clamped", "  return min(index, sample_count);", "  return index;"),
    ("indices of records are not clamped", "  return min(index, (uints)(sample_count));", "  return index;"),
    ("compilers may fuse what is not written as fused", "#pragma OPENCL FP_CONTRACT OFF",
     "#pragma OPENCL FP_CONTRACT ON"),
)


def failed_tests(build, folder, mutation):
    """The tests that fail, and whether a source was changed."""
    settings = {"TMPDIR": str(folder), "POCL_CACHE_DIR": str(folder), "NUTIK_TEST_SHAPE": "4,1,4,64,4,8"}
    if mutation is not None:
        settings |= {"LD_PRELOAD": str(build / "tests/libmutate_kernels.so"), "NUTIK_MUTATE_FROM": mutation[1],
                     "NUTIK_MUTATE_TO": mutation[2]}
    part = mutation[0].split(":")[0] if mutation is not None else ""
    tests = {"light": LIGHT_TESTS, "blending": BLENDING_TESTS, "steady": STEADY_TESTS}.get(part, TESTS)
    command = [str(build / "tests/opencl_tests"), f"--gtest_filter={tests}", "--gtest_brief=1"]
    done = subprocess.run(command, env=os.environ | settings, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, check=False)
    failed = sorted(set(re.findall(r"^\[  FAILED  \] (\S+?),? ", done.stdout, re.MULTILINE)))
    if done.returncode != 0 and not failed:
        sys.exit(f"the tests did not run:\n{done.stdout}{done.stderr}")
    return failed, "mutated" in done.stderr


def run(arguments):
    wanted = [each for each in MUTATIONS
              if not arguments.names or any(name in each[0] for name in arguments.names)]
    build = arguments.build.resolve()
    unnoticed = 0
    for mutation in (None, *wanted):
        with tempfile.TemporaryDirectory() as folder:
            failed, was_mutated = failed_tests(build, folder, mutation)
        if mutation is None:
            if failed:
                sys.exit(f"without a mutation there fail {', '.join(failed)}")
            continue
        if not was_mutated:
            sys.exit(f"{mutation[0]}: no kernel has the text\n{mutation[1]}")
        unnoticed += not failed
        print(f"{mutation[0]}: {', '.join(failed) or 'UNNOTICED'}", flush=True)
    print(f"{len(wanted)} mutations, {unnoticed} unnoticed")
    return 1 if unnoticed else 0
