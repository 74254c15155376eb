# SPDX-License-Identifier: MIT
# value opacity, for the MR head ch2.nii.gz (uint8). Air is below 30; skin begins at 40 to 60; fat and brain are above.
# With the default threshold 0.1 a sample is opaque from value 44.
40 0
80 1
