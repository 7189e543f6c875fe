"""Nacre: a DICOM series, a segmentation and a VTKHDF image as other programs write them. Usage: make_dicom.py FOLDER

All hold the volume of make_inputs.py, turned in space; truth.nrrd is the same volume where it should lie.
"""

import pathlib
import sys

import h5py
import highdicom
import numpy as np
import pydicom
from pydicom.sr.codedict import codes
from pydicom.uid import CTImageStorage, ExplicitVRLittleEndian, ImplicitVRLittleEndian, generate_uid

from make_inputs import NAMES, labels, write_segmentation

ROW, COLUMN = np.array([0.6, 0.8, 0]), np.array([-0.8, 0.6, 0])
SPACING, ORIGIN = (0.7, 0.8, 1.25), np.array([-10, 20, 5.0])


def slices(values, syntax):
    """One CT image per slice, in no order; stored numbers are half of the values plus 512."""
    normal = np.cross(ROW, COLUMN)
    study, series, frame = (generate_uid() for _ in range(3))
    for k in range(values.shape[2]):
        image = pydicom.Dataset()
        image.file_meta = pydicom.dataset.FileMetaDataset()
        image.file_meta.TransferSyntaxUID = syntax
        image.file_meta.MediaStorageSOPClassUID = image.SOPClassUID = CTImageStorage
        image.file_meta.MediaStorageSOPInstanceUID = image.SOPInstanceUID = generate_uid()
        image.StudyInstanceUID, image.SeriesInstanceUID, image.FrameOfReferenceUID = study, series, frame
        image.Modality, image.PatientID, image.PatientName, image.SeriesDescription = "CT", "1", "A^B", "bean"
        image.StudyDate = image.StudyTime = image.AccessionNumber = image.StudyID = ""
        image.PatientBirthDate = image.PatientSex = image.ReferringPhysicianName = ""
        image.SeriesNumber, image.InstanceNumber = 1, k + 1
        image.ImageOrientationPatient = [float(x) for x in (*ROW, *COLUMN)]
        image.ImagePositionPatient = [float(f"{x:.6f}") for x in ORIGIN + k * SPACING[2] * normal]
        image.PixelSpacing, image.SliceThickness = [SPACING[1], SPACING[0]], SPACING[2]
        image.Rows, image.Columns = values.shape[1], values.shape[0]
        image.SamplesPerPixel, image.PhotometricInterpretation = 1, "MONOCHROME2"
        image.BitsAllocated = image.BitsStored = 16
        image.HighBit, image.PixelRepresentation = 15, 0
        image.RescaleSlope, image.RescaleIntercept = 1, -512
        image.PixelData = (values[:, :, k].T + 512).astype("<u2").tobytes()
        yield image


def write_series(folder, values, syntax):
    folder.mkdir()
    images = list(slices(values, syntax))
    for k, image in enumerate(images):
        image.save_as(folder / f"IM{(7 * k) % len(images):03d}", enforce_file_format=True)
    return images


def write_segmentation_object(path, images, masks):
    """`masks`: x, y, z, segment."""
    descriptions = [
        highdicom.seg.SegmentDescription(
            number, name, codes.cid7150.Tissue, codes.SCT.Organ,
            highdicom.seg.SegmentAlgorithmTypeValues.MANUAL)
        for number, name in enumerate(NAMES.values(), 1)
    ]
    seg = highdicom.seg.Segmentation(
        source_images=images, pixel_array=masks.transpose(2, 1, 0, 3).astype(np.uint8),
        segmentation_type=highdicom.seg.SegmentationTypeValues.BINARY, segment_descriptions=descriptions,
        series_instance_uid=generate_uid(), series_number=2, sop_instance_uid=generate_uid(), instance_number=1,
        manufacturer="A", manufacturer_model_name="A", software_versions="1", device_serial_number="1",
        omit_empty_frames=True)
    seg.save_as(path, enforce_file_format=True)


def write_vtkhdf(path, values):
    with h5py.File(path, "w") as file:
        group = file.create_group("VTKHDF")
        group.attrs["Version"] = np.array([1, 0])
        group.attrs.create("Type", np.bytes_("ImageData"))
        group.attrs["WholeExtent"] = np.array([e for n in values.shape for e in (0, n - 1)])
        group.attrs["Origin"] = np.array([-10, 20, 5.0])
        group.attrs["Spacing"] = np.array(SPACING)
        group.attrs["Direction"] = np.eye(3).ravel()
        group.create_group("PointData").create_dataset("labels", data=values.transpose(2, 1, 0).astype(np.int16))


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    values = labels().astype(np.int16)
    directions = (ROW, COLUMN, np.cross(ROW, COLUMN))
    write_segmentation(folder / "truth.seg.nrrd", values.astype(np.uint16), NAMES, SPACING, tuple(ORIGIN), directions)
    images = write_series(folder / "series", values, ExplicitVRLittleEndian)
    write_series(folder / "implicit", values, ImplicitVRLittleEndian)
    apart = np.stack([values == label for label in NAMES], axis=-1)
    write_segmentation_object(folder / "segments.dcm", images, apart)
    numbered = np.select([values == label for label in NAMES], [1, 2]).astype(np.uint16)
    names = dict(enumerate(NAMES.values(), 1))
    write_segmentation(folder / "numbered.seg.nrrd", numbered, names, SPACING, tuple(ORIGIN), directions)
    grown = apart.copy()
    grown[1:, :, :, 0] |= apart[:-1, :, :, 0]
    write_segmentation_object(folder / "overlapping.dcm", images, grown)
    one_less = list(slices(values, ExplicitVRLittleEndian))
    del one_less[8]
    (folder / "gap").mkdir()
    for k, image in enumerate(one_less):
        image.save_as(folder / "gap" / f"{k}.dcm", enforce_file_format=True)
    (folder / "two").mkdir()
    for k in range(2):
        write_series(folder / "two" / str(k), values, ExplicitVRLittleEndian)
    write_vtkhdf(folder / "image.vtkhdf", values)
