# SPDX-License-Identifier: MIT
"""What nibabel says of NIfTI files: a line each, `NAME ok`, the 12 numbers of the affine (RAS, rows), the number of
voxels and the values of 2,000 of them or fewer, first index fastest; or `NAME refused`."""
import logging
import sys
import warnings

import nibabel

logging.disable(logging.CRITICAL)
warnings.simplefilter("ignore")
for name in sys.argv[1:]:
    try:
        image = nibabel.load(name)
        values = image.get_fdata().ravel(order="F")
        numbers = [*image.affine[:3].ravel(), len(values), *values[:: (len(values) + 1999) // 2000]]
        print(name, "ok", *(float(number).hex() for number in numbers))
    except (AttributeError, NameError, TypeError):
        raise  # this script's own fault
    except Exception as problem:
        print(name, "refused", repr(problem))
