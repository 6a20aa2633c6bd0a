# ruff: noqa - MuJoCo's names
"""The part of MuJoCo's Python API that ravemj uses, for the type checker.

MuJoCo's wheels carry no type information. Arrays of models and data are views: writing into them changes the
model. Enumerations behave like integers.
"""

from collections.abc import Callable, Mapping, Sequence
from enum import IntEnum
from typing import Any, SupportsInt

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]
Bytes = NDArray[np.uint8]
Bools = NDArray[np.bool_]

__version__: str
mjVERSION_HEADER: int
mjMINVAL: float
mjMAXVAL: float
mjPI: float
mjNEQDATA: int
mjNGROUP: int

class FatalError(Exception): ...
class UnexpectedError(Exception): ...

class mjtObj(IntEnum):
    mjOBJ_UNKNOWN = 0
    mjOBJ_BODY = 1
    mjOBJ_XBODY = 2
    mjOBJ_JOINT = 3
    mjOBJ_DOF = 4
    mjOBJ_GEOM = 5
    mjOBJ_SITE = 6
    mjOBJ_CAMERA = 7
    mjOBJ_LIGHT = 8
    mjOBJ_FLEX = 9
    mjOBJ_MESH = 10
    mjOBJ_SKIN = 11
    mjOBJ_HFIELD = 12
    mjOBJ_TEXTURE = 13
    mjOBJ_MATERIAL = 14
    mjOBJ_PAIR = 15
    mjOBJ_EXCLUDE = 16
    mjOBJ_EQUALITY = 17
    mjOBJ_TENDON = 18
    mjOBJ_ACTUATOR = 19
    mjOBJ_SENSOR = 20
    mjOBJ_NUMERIC = 21
    mjOBJ_TEXT = 22
    mjOBJ_TUPLE = 23
    mjOBJ_KEY = 24
    mjOBJ_PLUGIN = 25
    mjNOBJECT = 26
    mjOBJ_FRAME = 100
    mjOBJ_DEFAULT = 101
    mjOBJ_MODEL = 102

class mjtGeom(IntEnum):
    mjGEOM_PLANE = 0
    mjGEOM_HFIELD = 1
    mjGEOM_SPHERE = 2
    mjGEOM_CAPSULE = 3
    mjGEOM_ELLIPSOID = 4
    mjGEOM_CYLINDER = 5
    mjGEOM_BOX = 6
    mjGEOM_MESH = 7
    mjGEOM_SDF = 8
    mjNGEOMTYPES = 9
    mjGEOM_ARROW = 100
    mjGEOM_ARROW1 = 101
    mjGEOM_ARROW2 = 102
    mjGEOM_LINE = 103
    mjGEOM_LINEBOX = 104
    mjGEOM_FLEX = 105
    mjGEOM_SKIN = 106
    mjGEOM_LABEL = 107
    mjGEOM_TRIANGLE = 108
    mjGEOM_NONE = 1001

class mjtJoint(IntEnum):
    mjJNT_FREE = 0
    mjJNT_BALL = 1
    mjJNT_SLIDE = 2
    mjJNT_HINGE = 3

class mjtEq(IntEnum):
    mjEQ_CONNECT = 0
    mjEQ_WELD = 1
    mjEQ_JOINT = 2
    mjEQ_TENDON = 3
    mjEQ_FLEX = 4
    mjEQ_FLEXVERT = 5
    mjEQ_FLEXSTRAIN = 6
    mjEQ_DISTANCE = 7

class mjtTrn(IntEnum):
    mjTRN_JOINT = 0
    mjTRN_JOINTINPARENT = 1

class mjtGain(IntEnum):
    mjGAIN_FIXED = 0

class mjtBias(IntEnum):
    mjBIAS_NONE = 0

class mjtWrap(IntEnum):
    mjWRAP_JOINT = 1

class mjtCamLight(IntEnum):
    mjCAMLIGHT_FIXED = 0

class mjtTexture(IntEnum):
    mjTEXTURE_2D = 0
    mjTEXTURE_CUBE = 1
    mjTEXTURE_SKYBOX = 2

class mjtLightType(IntEnum):
    mjLIGHT_SPOT = 0
    mjLIGHT_DIRECTIONAL = 1
    mjLIGHT_POINT = 2
    mjLIGHT_IMAGE = 3

class mjtCamera(IntEnum):
    mjCAMERA_FREE = 0
    mjCAMERA_TRACKING = 1
    mjCAMERA_FIXED = 2
    mjCAMERA_USER = 3

class mjtCatBit(IntEnum):
    mjCAT_STATIC = 1
    mjCAT_DYNAMIC = 2
    mjCAT_DECOR = 4
    mjCAT_ALL = 7

class mjtFont(IntEnum):
    mjFONT_NORMAL = 0
    mjFONT_SHADOW = 1
    mjFONT_BIG = 2

class mjtFontScale(IntEnum):
    mjFONTSCALE_50 = 50
    mjFONTSCALE_100 = 100
    mjFONTSCALE_150 = 150
    mjFONTSCALE_200 = 200
    mjFONTSCALE_250 = 250
    mjFONTSCALE_300 = 300

class mjtFramebuffer(IntEnum):
    mjFB_WINDOW = 0
    mjFB_OFFSCREEN = 1

class mjtGridPos(IntEnum):
    mjGRID_TOPLEFT = 0
    mjGRID_TOPRIGHT = 1
    mjGRID_BOTTOMLEFT = 2
    mjGRID_BOTTOMRIGHT = 3
    mjGRID_TOP = 4
    mjGRID_BOTTOM = 5
    mjGRID_LEFT = 6
    mjGRID_RIGHT = 7

class mjtRndFlag(IntEnum):
    mjRND_SHADOW = 0
    mjRND_WIREFRAME = 1
    mjRND_REFLECTION = 2
    mjRND_ADDITIVE = 3
    mjRND_SKYBOX = 4
    mjRND_FOG = 5
    mjRND_HAZE = 6
    mjRND_DEPTH = 7
    mjRND_SEGMENT = 8
    mjRND_IDCOLOR = 9
    mjRND_CULL_FACE = 10
    mjRND_POST_PROCESSING = 11
    mjNRNDFLAG = 12

class mjtVisFlag(IntEnum):
    mjVIS_CONVEXHULL = 0
    mjVIS_TEXTURE = 1
    mjVIS_JOINT = 2
    mjVIS_CAMERA = 3
    mjVIS_ACTUATOR = 4
    mjVIS_ACTIVATION = 5
    mjVIS_LIGHT = 6
    mjVIS_TENDON = 7
    mjVIS_RANGEFINDER = 8
    mjVIS_CONSTRAINT = 9
    mjVIS_INERTIA = 10
    mjVIS_SCLINERTIA = 11
    mjVIS_PERTFORCE = 12
    mjVIS_PERTOBJ = 13
    mjVIS_CONTACTPOINT = 14
    mjVIS_ISLAND = 15
    mjVIS_CONTACTFORCE = 16
    mjVIS_CONTACTSPLIT = 17
    mjVIS_TRANSPARENT = 18
    mjVIS_AUTOCONNECT = 19
    mjVIS_COM = 20
    mjVIS_SELECT = 21
    mjVIS_STATIC = 22
    mjVIS_SKIN = 23
    mjVIS_FLEXVERT = 24
    mjVIS_FLEXEDGE = 25
    mjVIS_FLEXFACE = 26
    mjVIS_FLEXSKIN = 27
    mjVIS_BODYBVH = 28
    mjVIS_MESHBVH = 29
    mjVIS_SDFITER = 30
    mjNVISFLAG = 31

class mjtCone(IntEnum):
    mjCONE_PYRAMIDAL = 0
    mjCONE_ELLIPTIC = 1

class mjtIntegrator(IntEnum):
    mjINT_EULER = 0
    mjINT_RK4 = 1
    mjINT_IMPLICIT = 2
    mjINT_IMPLICITFAST = 3

class mjtDisableBit(IntEnum):
    mjDSBL_CONSTRAINT = 1
    mjDSBL_EQUALITY = 2
    mjDSBL_FRICTIONLOSS = 4
    mjDSBL_LIMIT = 8
    mjDSBL_CONTACT = 16
    mjDSBL_SPRING = 32
    mjDSBL_DAMPER = 64
    mjDSBL_GRAVITY = 128
    mjDSBL_CLAMPCTRL = 256
    mjDSBL_WARMSTART = 512
    mjDSBL_FILTERPARENT = 1024
    mjDSBL_ACTUATION = 2048
    mjDSBL_REFSAFE = 4096
    mjDSBL_SENSOR = 8192
    mjDSBL_MIDPHASE = 16384
    mjDSBL_EULERDAMP = 32768
    mjDSBL_AUTORESET = 65536
    mjDSBL_NATIVECCD = 131072
    mjDSBL_ISLAND = 262144
    mjDSBL_MULTICCD = 524288
    mjNDISABLE = 20

class mjtWarning(IntEnum):
    mjWARN_INERTIA = 0
    mjWARN_CONTACTFULL = 1
    mjWARN_CNSTRFULL = 2
    mjWARN_BADQPOS = 3
    mjWARN_BADQVEL = 4
    mjWARN_BADQACC = 5
    mjWARN_BADCTRL = 6
    mjNWARNING = 7

class _MjWarningStatList:
    number: Ints

class mjtEnableBit(IntEnum):
    mjENBL_OVERRIDE = 1
    mjENBL_ENERGY = 2
    mjENBL_FWDINV = 4
    mjENBL_INVDISCRETE = 8
    mjENBL_SLEEP = 16
    mjENBL_DIAGEXACT = 32
    mjENBL_IPC = 64
    mjENBL_SPECULATIVE = 128
    mjNENABLE = 8

class mjtState(IntEnum):
    mjSTATE_TIME = 1
    mjSTATE_QPOS = 2
    mjSTATE_QVEL = 4
    mjSTATE_ACT = 8
    mjSTATE_HISTORY = 16
    mjSTATE_WARMSTART = 32
    mjSTATE_CTRL = 64
    mjSTATE_QFRC_APPLIED = 128
    mjSTATE_XFRC_APPLIED = 256
    mjSTATE_EQ_ACTIVE = 512
    mjSTATE_MOCAP_POS = 1024
    mjSTATE_MOCAP_QUAT = 2048
    mjSTATE_USERDATA = 4096
    mjSTATE_PLUGIN = 8192
    mjSTATE_PLASTIC = 16384
    mjNSTATE = 15
    mjSTATE_PHYSICS = 16414
    mjSTATE_FULLPHYSICS = 24607
    mjSTATE_USER = 8128
    mjSTATE_INTEGRATION = 32767

class MjOption:
    ccd_iterations: int
    ccd_tolerance: float
    cone: int
    density: float
    disableactuator: int
    disableflags: int
    enableflags: int
    gravity: Floats
    impratio: float
    integrator: int
    iterations: int
    jacobian: int
    ls_iterations: int
    ls_tolerance: float
    magnetic: Floats
    noslip_iterations: int
    noslip_tolerance: float
    o_friction: Floats
    o_margin: float
    o_solimp: Floats
    o_solref: Floats
    sdf_initpoints: int
    sdf_iterations: int
    sleep_tolerance: float
    solver: int
    timestep: float
    tolerance: float
    viscosity: float
    wind: Floats

class MjStatistic:
    center: Floats
    extent: float
    meaninertia: float
    meanmass: float
    meansize: float

class MjVisual:
    class Global:
        azimuth: float
        bvactive: int
        cameraid: int
        elevation: float
        ellipsoidinertia: int
        fovy: float
        glow: float
        ipd: float
        linewidth: float
        offheight: int
        offwidth: int
        orthographic: int
        realtime: float

    class Headlight:
        active: int
        ambient: Floats32
        diffuse: Floats32
        specular: Floats32

    class Map:
        actuatortendon: float
        alpha: float
        fogend: float
        fogstart: float
        force: float
        haze: float
        shadowclip: float
        shadowscale: float
        stiffness: float
        stiffnessrot: float
        torque: float
        zfar: float
        znear: float

    class Quality:
        numquads: int
        numslices: int
        numstacks: int
        offsamples: int
        shadowsize: int

    class Rgba:
        actuator: Floats32
        actuatornegative: Floats32
        actuatorpositive: Floats32
        bv: Floats32
        bvactive: Floats32
        camera: Floats32
        com: Floats32
        connect: Floats32
        constraint: Floats32
        contactforce: Floats32
        contactfriction: Floats32
        contactgap: Floats32
        contactpoint: Floats32
        contacttorque: Floats32
        crankbroken: Floats32
        fog: Floats32
        force: Floats32
        frustum: Floats32
        haze: Floats32
        inertia: Floats32
        joint: Floats32
        light: Floats32
        rangefinder: Floats32
        selectpoint: Floats32
        slidercrank: Floats32

    class Scale:
        actuatorlength: float
        actuatorwidth: float
        camera: float
        com: float
        connect: float
        constraint: float
        contactheight: float
        contactwidth: float
        forcewidth: float
        framelength: float
        framewidth: float
        frustum: float
        jointlength: float
        jointwidth: float
        light: float
        selectpoint: float
        slidercrank: float

    global_: Global
    headlight: Headlight
    map: Map
    quality: Quality
    rgba: Rgba
    scale: Scale

class MjModel:
    @staticmethod
    def from_xml_string(xml: str, assets: Mapping[str, bytes] | None = ..., vfs: MjVfs | None = ...) -> MjModel: ...
    @staticmethod
    def from_xml_path(filename: str, assets: Mapping[str, bytes] | None = ..., vfs: MjVfs | None = ...) -> MjModel: ...
    @staticmethod
    def from_binary_path(filename: str) -> MjModel: ...
    def __copy__(self) -> MjModel: ...
    def __deepcopy__(self, memo: dict[int, Any]) -> MjModel: ...
    def actuator(self, name: str | int = ...) -> Any: ...
    def body(self, name: str | int = ...) -> Any: ...
    def cam(self, name: str | int = ...) -> Any: ...
    def camera(self, name: str | int = ...) -> Any: ...
    def eq(self, name: str | int = ...) -> Any: ...
    def equality(self, name: str | int = ...) -> Any: ...
    def exclude(self, name: str | int = ...) -> Any: ...
    def geom(self, name: str | int = ...) -> Any: ...
    def jnt(self, name: str | int = ...) -> Any: ...
    def joint(self, name: str | int = ...) -> Any: ...
    def key(self, name: str | int = ...) -> Any: ...
    def light(self, name: str | int = ...) -> Any: ...
    def mat(self, name: str | int = ...) -> Any: ...
    def material(self, name: str | int = ...) -> Any: ...
    def mesh(self, name: str | int = ...) -> Any: ...
    def pair(self, name: str | int = ...) -> Any: ...
    def sensor(self, name: str | int = ...) -> Any: ...
    def site(self, name: str | int = ...) -> Any: ...
    def tendon(self, name: str | int = ...) -> Any: ...
    def tex(self, name: str | int = ...) -> Any: ...
    opt: MjOption
    stat: MjStatistic
    vis: MjVisual
    actuator_acc0: Floats
    actuator_actadr: Ints
    actuator_actearly: Bools
    actuator_actlimited: Bools
    actuator_actnum: Ints
    actuator_actrange: Floats
    actuator_armature: Floats
    actuator_biasprm: Floats
    actuator_biastype: Ints
    actuator_cranklength: Floats
    actuator_ctrladr: Ints
    actuator_ctrllimited: Bools
    actuator_ctrlnum: Ints
    actuator_ctrlrange: Floats
    actuator_ctrlspec: Ints
    actuator_damping: Floats
    actuator_dampingpoly: Floats
    actuator_delay: Floats
    actuator_dynprm: Floats
    actuator_dyntype: Ints
    actuator_forcelimited: Bools
    actuator_forcerange: Floats
    actuator_gainprm: Floats
    actuator_gaintype: Ints
    actuator_gear: Floats
    actuator_group: Ints
    actuator_history: Ints
    actuator_historyadr: Ints
    actuator_length0: Floats
    actuator_lengthrange: Floats
    actuator_outadr: Ints
    actuator_outnum: Ints
    actuator_plugin: Ints
    actuator_trnid: Ints
    actuator_trntype: Ints
    actuator_user: Floats
    body_bvhadr: Ints
    body_bvhnum: Ints
    body_conaffinity: Ints
    body_contype: Ints
    body_dofadr: Ints
    body_dofnum: Ints
    body_geomadr: Ints
    body_geomnum: Ints
    body_gravcomp: Floats
    body_inertia: Floats
    body_invweight0: Floats
    body_ipos: Floats
    body_iquat: Floats
    body_jntadr: Ints
    body_jntnum: Ints
    body_margin: Floats
    body_mass: Floats
    body_mocapid: Ints
    body_parentid: Ints
    body_plugin: Ints
    body_pos: Floats
    body_quat: Floats
    body_rootid: Ints
    body_sameframe: Bytes
    body_simple: Bytes
    body_subtreemass: Floats
    body_treeid: Ints
    body_user: Floats
    body_weldid: Ints
    exclude_signature: Ints
    cam_bodyid: Ints
    cam_fovy: Floats
    cam_intrinsic: Floats32
    cam_ipd: Floats
    cam_mat0: Floats
    cam_mode: Ints
    cam_output: Ints
    cam_pos: Floats
    cam_pos0: Floats
    cam_poscom0: Floats
    cam_projection: Ints
    cam_quat: Floats
    cam_resolution: Ints
    cam_sensorsize: Floats32
    cam_targetbodyid: Ints
    cam_user: Floats
    dof_M0: Floats
    dof_Madr: Ints
    dof_armature: Floats
    dof_bodyid: Ints
    dof_damping: Floats
    dof_dampingpoly: Floats
    dof_frictionloss: Floats
    dof_invweight0: Floats
    dof_jntid: Ints
    dof_length: Floats
    dof_parentid: Ints
    dof_simplenum: Ints
    dof_solimp: Floats
    dof_solref: Floats
    dof_treeid: Ints
    eq_active0: Bools
    eq_data: Floats
    eq_obj1id: Ints
    eq_obj2id: Ints
    eq_objtype: Ints
    eq_solimp: Floats
    eq_solref: Floats
    eq_type: Ints
    geom_aabb: Floats
    geom_adhesion: Floats
    geom_bodyid: Ints
    geom_castshadow: Bools
    geom_conaffinity: Ints
    geom_condim: Ints
    geom_contype: Ints
    geom_dataid: Ints
    geom_fluid: Floats
    geom_friction: Floats
    geom_gap: Floats
    geom_group: Ints
    geom_margin: Floats
    geom_matid: Ints
    geom_plugin: Ints
    geom_pos: Floats
    geom_priority: Ints
    geom_quat: Floats
    geom_rbound: Floats
    geom_rgba: Floats32
    geom_sameframe: Bytes
    geom_size: Floats
    geom_solimp: Floats
    geom_solmix: Floats
    geom_solref: Floats
    geom_surfacevel: Floats
    geom_type: Ints
    geom_user: Floats
    jnt_actfrclimited: Bools
    jnt_actfrcrange: Floats
    jnt_actgravcomp: Bools
    jnt_actuatorid: Ints
    jnt_axis: Floats
    jnt_bodyid: Ints
    jnt_dofadr: Ints
    jnt_group: Ints
    jnt_limited: Bools
    jnt_margin: Floats
    jnt_plasticadr: Ints
    jnt_pos: Floats
    jnt_qposadr: Ints
    jnt_range: Floats
    jnt_solimp: Floats
    jnt_solref: Floats
    jnt_springyield: Floats
    jnt_stiffness: Floats
    jnt_stiffnesspoly: Floats
    jnt_type: Ints
    jnt_user: Floats
    key_act: Floats
    key_ctrl: Floats
    key_mpos: Floats
    key_mquat: Floats
    key_plastic: Floats
    key_qpos: Floats
    key_qvel: Floats
    key_time: Floats
    light_active: Bools
    light_ambient: Floats32
    light_attenuation: Floats32
    light_bodyid: Ints
    light_bulbradius: Floats32
    light_castshadow: Bools
    light_cutoff: Floats32
    light_diffuse: Floats32
    light_dir: Floats
    light_dir0: Floats
    light_exponent: Floats32
    light_intensity: Floats32
    light_mode: Ints
    light_pos: Floats
    light_pos0: Floats
    light_poscom0: Floats
    light_range: Floats32
    light_softness: Floats32
    light_specular: Floats32
    light_targetbodyid: Ints
    light_texid: Ints
    light_type: Ints
    mat_emission: Floats32
    mat_metallic: Floats32
    mat_reflectance: Floats32
    mat_rgba: Floats32
    mat_roughness: Floats32
    mat_shininess: Floats32
    mat_specular: Floats32
    mat_texid: Ints
    mat_texrepeat: Floats32
    mat_texuniform: Bools
    mesh_face: Ints
    mesh_faceadr: Ints
    mesh_facenormal: Ints
    mesh_facenum: Ints
    mesh_facetexcoord: Ints
    mesh_graph: Ints
    mesh_graphadr: Ints
    mesh_pos: Floats
    mesh_quat: Floats
    mesh_vert: Floats32
    mesh_normal: Floats32
    mesh_normaladr: Ints
    mesh_vertadr: Ints
    mesh_vertnum: Ints
    na: int
    name_actuatoradr: Ints
    name_bodyadr: Ints
    name_camadr: Ints
    name_eqadr: Ints
    name_excludeadr: Ints
    name_flexadr: Ints
    name_geomadr: Ints
    name_hfieldadr: Ints
    name_jntadr: Ints
    name_keyadr: Ints
    name_lightadr: Ints
    name_matadr: Ints
    name_meshadr: Ints
    name_numericadr: Ints
    name_pairadr: Ints
    name_pluginadr: Ints
    name_sensoradr: Ints
    name_siteadr: Ints
    name_skinadr: Ints
    name_tendonadr: Ints
    name_texadr: Ints
    name_textadr: Ints
    name_tupleadr: Ints
    names: bytes
    nbody: int
    ncam: int
    neq: int
    nexclude: int
    nflex: int
    ngeom: int
    nhfield: int
    njnt: int
    nkey: int
    nlight: int
    nmat: int
    nmesh: int
    nmeshface: int
    nmeshvert: int
    nmocap: int
    npair: int
    nq: int
    nsensor: int
    nsensordata: int
    nsite: int
    nskin: int
    ntendon: int
    ntex: int
    ntree: int
    nu: int
    nuserdata: int
    nv: int
    qpos0: Floats
    qpos_spring: Floats
    site_bodyid: Ints
    site_dataid: Ints
    site_group: Ints
    site_matid: Ints
    site_pos: Floats
    site_quat: Floats
    site_rgba: Floats32
    site_sameframe: Bytes
    site_size: Floats
    site_type: Ints
    site_user: Floats
    tex_adr: NDArray[np.int64]
    tex_colorspace: Ints
    tex_contenttypeadr: Ints
    tex_data: Bytes
    tex_height: Ints
    tex_nchannel: Ints
    tex_pathadr: Ints
    tex_type: Ints
    tex_width: Ints
    hfield_adr: Ints
    hfield_data: Floats32
    hfield_ncol: Ints
    hfield_nrow: Ints
    hfield_size: Floats
    pair_geom1: Ints
    pair_geom2: Ints
    tendon_adr: Ints
    tendon_num: Ints
    wrap_objid: Ints
    wrap_prm: Floats
    wrap_type: Ints

class MjContact:
    H: Floats
    adhesion: float
    dim: int
    dist: float
    efc_address: int
    elem: Ints
    exclude: int
    flex: Ints
    frame: Floats
    friction: Floats
    geom: Ints
    geom1: int
    geom2: int
    includemargin: float
    mu: float
    pos: Floats
    solimp: Floats
    solref: Floats
    solreffriction: Floats
    surfacevel: Floats
    vert: Ints

class _MjContactList(Sequence[MjContact]):
    dim: Ints
    dist: Floats
    geom: Ints
    geom1: Ints
    geom2: Ints
    pos: Floats
    frame: Floats
    def __len__(self) -> int: ...
    def __getitem__(self, index: Any) -> Any: ...

class MjData:
    def __init__(self, model: MjModel) -> None: ...
    def __copy__(self) -> MjData: ...
    def __deepcopy__(self, memo: dict[int, Any]) -> MjData: ...
    @property
    def model(self) -> MjModel: ...
    @property
    def contact(self) -> _MjContactList: ...
    @property
    def warning(self) -> _MjWarningStatList: ...
    def actuator(self, name: str | int = ...) -> Any: ...
    def body(self, name: str | int = ...) -> Any: ...
    def cam(self, name: str | int = ...) -> Any: ...
    def camera(self, name: str | int = ...) -> Any: ...
    def geom(self, name: str | int = ...) -> Any: ...
    def jnt(self, name: str | int = ...) -> Any: ...
    def joint(self, name: str | int = ...) -> Any: ...
    def light(self, name: str | int = ...) -> Any: ...
    def sensor(self, name: str | int = ...) -> Any: ...
    def site(self, name: str | int = ...) -> Any: ...
    def tendon(self, name: str | int = ...) -> Any: ...
    M: Floats
    act: Floats
    act_dot: Floats
    actuator_force: Floats
    actuator_length: Floats
    actuator_moment: Floats
    actuator_velocity: Floats
    body_awake: Ints
    body_awake_ind: Ints
    cacc: Floats
    cam_xmat: Floats
    cam_xpos: Floats
    cdof: Floats
    cdof_dot: Floats
    cfrc_ext: Floats
    cfrc_int: Floats
    cinert: Floats
    crb: Floats
    ctrl: Floats
    cvel: Floats
    dof_awake_ind: Ints
    dof_island: Ints
    efc_AR: Floats
    efc_AR_colind: Ints
    efc_AR_rowadr: Ints
    efc_AR_rownnz: Ints
    efc_D: Floats
    efc_J: Floats
    efc_J_colind: Ints
    efc_J_rowadr: Ints
    efc_J_rownnz: Ints
    efc_J_rowsuper: Ints
    efc_KBIP: Floats
    efc_R: Floats
    efc_Y: Floats
    efc_Y_colind: Ints
    efc_Y_rowadr: Ints
    efc_Y_rownnz: Ints
    efc_aref: Floats
    efc_b: Floats
    efc_diagA: Floats
    efc_force: Floats
    efc_frictionloss: Floats
    efc_id: Ints
    efc_island: Ints
    efc_margin: Floats
    efc_pos: Floats
    efc_state: Ints
    efc_type: Ints
    efc_vel: Floats
    energy: Floats
    eq_active: Bools
    flg_energypos: bool
    flg_energyvel: bool
    flg_rnepost: bool
    flg_subtreevel: bool
    geom_xmat: Floats
    geom_xpos: Floats
    geom_xquat: Floats
    history: Floats
    light_xdir: Floats
    light_xpos: Floats
    mocap_pos: Floats
    mocap_quat: Floats
    nA: int
    nJ: int
    nY: int
    narena: int
    nbody_awake: int
    nbuffer: int
    ncon: int
    ne: int
    nefc: int
    nf: int
    nidof: int
    nisland: int
    nl: int
    nparent_awake: int
    nplugin: int
    ntree_awake: int
    nv_awake: int
    parena: int
    parent_awake_ind: Ints
    pbase: int
    plastic: Floats
    pstack: int
    qLD: Floats
    qLDiagInv: Floats
    qacc: Floats
    qacc_smooth: Floats
    qacc_warmstart: Floats
    qfrc_actuator: Floats
    qfrc_applied: Floats
    qfrc_bias: Floats
    qfrc_constraint: Floats
    qfrc_damper: Floats
    qfrc_gravcomp: Floats
    qfrc_inverse: Floats
    qfrc_passive: Floats
    qfrc_smooth: Floats
    qfrc_spring: Floats
    qpos: Floats
    qvel: Floats
    sensordata: Floats
    signature: int
    site_xmat: Floats
    site_xpos: Floats
    site_xquat: Floats
    subtree_angmom: Floats
    subtree_com: Floats
    subtree_linvel: Floats
    ten_J: Floats
    ten_length: Floats
    ten_velocity: Floats
    tendon_efcadr: Ints
    threadpool: int
    time: float
    userdata: Floats
    xanchor: Floats
    xaxis: Floats
    xfrc_applied: Floats
    ximat: Floats
    xipos: Floats
    xiquat: Floats
    xmat: Floats
    xpos: Floats
    xquat: Floats

class MjVfs:
    def __enter__(self) -> MjVfs: ...
    def __exit__(self, *args: object) -> None: ...
    def __setitem__(self, name: str, content: bytes) -> None: ...
    def __getitem__(self, name: str) -> bytes: ...
    def __contains__(self, name: str) -> bool: ...
    def close(self) -> None: ...

class MjSpec:
    def __init__(self) -> None: ...
    @staticmethod
    def from_string(
        xml: str,
        include: Mapping[str, bytes] | None = ...,
        assets: Mapping[str, bytes] | None = ...,
        vfs: MjVfs | None = ...,
    ) -> MjSpec: ...
    @staticmethod
    def from_file(
        filename: str,
        include: Mapping[str, bytes] | None = ...,
        assets: Mapping[str, bytes] | None = ...,
        vfs: MjVfs | None = ...,
    ) -> MjSpec: ...
    def compile(self, vfs: MjVfs | None = ...) -> MjModel: ...
    def recompile(self, m: MjModel, d: MjData, vfs: MjVfs | None = ...) -> tuple[MjModel, MjData]: ...
    def to_xml(self) -> str: ...
    def to_file(self, filename: str) -> None: ...
    def copy(self) -> MjSpec: ...
    def attach(
        self,
        child: MjSpec,
        prefix: str | None = ...,
        suffix: str | None = ...,
        site: Any = ...,
        frame: Any = ...,
    ) -> Any: ...
    def delete(self, element: Any) -> None: ...
    def actuator(self, name: str) -> Any: ...
    def body(self, name: str) -> Any: ...
    def camera(self, name: str) -> Any: ...
    def equality(self, name: str) -> Any: ...
    def exclude(self, name: str) -> Any: ...
    def frame(self, name: str) -> Any: ...
    def geom(self, name: str) -> Any: ...
    def joint(self, name: str) -> Any: ...
    def key(self, name: str) -> Any: ...
    def light(self, name: str) -> Any: ...
    def material(self, name: str) -> Any: ...
    def mesh(self, name: str) -> Any: ...
    def pair(self, name: str) -> Any: ...
    def sensor(self, name: str) -> Any: ...
    def site(self, name: str) -> Any: ...
    def tendon(self, name: str) -> Any: ...
    def texture(self, name: str) -> Any: ...
    def add_actuator(self, **fields: Any) -> Any: ...
    def add_default(self, **fields: Any) -> Any: ...
    def add_equality(self, **fields: Any) -> Any: ...
    def add_exclude(self, **fields: Any) -> Any: ...
    def add_key(self, **fields: Any) -> Any: ...
    def add_material(self, **fields: Any) -> Any: ...
    def add_mesh(self, **fields: Any) -> Any: ...
    def add_pair(self, **fields: Any) -> Any: ...
    def add_sensor(self, **fields: Any) -> Any: ...
    def add_tendon(self, **fields: Any) -> Any: ...
    def add_texture(self, **fields: Any) -> Any: ...
    actuators: list[Any]
    bodies: list[Any]
    cameras: list[Any]
    equalities: list[Any]
    excludes: list[Any]
    frames: list[Any]
    geoms: list[Any]
    hfields: list[Any]
    joints: list[Any]
    keys: list[Any]
    lights: list[Any]
    materials: list[Any]
    meshes: list[Any]
    pairs: list[Any]
    sensors: list[Any]
    sites: list[Any]
    skins: list[Any]
    tendons: list[Any]
    texts: list[Any]
    textures: list[Any]
    assets: dict[str, bytes]
    comment: str
    compiler: Any
    default: Any
    memory: int
    meshdir: str
    modelfiledir: str
    modelname: str
    nconmax: int
    njmax: int
    option: MjOption
    stat: MjStatistic
    texturedir: str
    visual: MjVisual
    worldbody: Any

class MjvCamera:
    azimuth: float
    distance: float
    elevation: float
    fixedcamid: int
    lookat: Floats
    orthographic: int
    trackbodyid: int
    type: int

class MjvGLCamera:
    @property
    def forward(self) -> Floats32: ...
    @forward.setter
    def forward(self, value: ArrayLike) -> None: ...
    @property
    def pos(self) -> Floats32: ...
    @pos.setter
    def pos(self, value: ArrayLike) -> None: ...
    @property
    def up(self) -> Floats32: ...
    @up.setter
    def up(self, value: ArrayLike) -> None: ...
    frustum_bottom: float
    frustum_center: float
    frustum_far: float
    frustum_near: float
    frustum_top: float
    frustum_width: float
    orthographic: int

class MjvGeom:
    def __init__(self) -> None: ...
    label: str
    @property
    def mat(self) -> Floats32: ...
    @mat.setter
    def mat(self, value: ArrayLike) -> None: ...
    @property
    def pos(self) -> Floats32: ...
    @pos.setter
    def pos(self, value: ArrayLike) -> None: ...
    @property
    def rgba(self) -> Floats32: ...
    @rgba.setter
    def rgba(self, value: ArrayLike) -> None: ...
    @property
    def size(self) -> Floats32: ...
    @size.setter
    def size(self, value: ArrayLike) -> None: ...
    @property
    def texrepeat(self) -> Floats32: ...
    @texrepeat.setter
    def texrepeat(self, value: ArrayLike) -> None: ...
    camdist: float
    castshadow: int
    category: int
    dataid: int
    emission: float
    matid: int
    modelrbound: float
    objid: int
    objtype: int
    reflectance: float
    segid: int
    shininess: float
    specular: float
    texcoord: int
    texid: int
    texuniform: int
    transparent: int
    type: int

class MjvLight:
    @property
    def ambient(self) -> Floats32: ...
    @ambient.setter
    def ambient(self, value: ArrayLike) -> None: ...
    @property
    def attenuation(self) -> Floats32: ...
    @attenuation.setter
    def attenuation(self, value: ArrayLike) -> None: ...
    @property
    def diffuse(self) -> Floats32: ...
    @diffuse.setter
    def diffuse(self, value: ArrayLike) -> None: ...
    @property
    def dir(self) -> Floats32: ...
    @dir.setter
    def dir(self, value: ArrayLike) -> None: ...
    @property
    def pos(self) -> Floats32: ...
    @pos.setter
    def pos(self, value: ArrayLike) -> None: ...
    @property
    def specular(self) -> Floats32: ...
    @specular.setter
    def specular(self, value: ArrayLike) -> None: ...
    bulbradius: float
    castshadow: int
    cutoff: float
    exponent: float
    headlight: int
    id: int
    intensity: float
    range: float
    softness: float
    texid: int
    type: int

class MjvOption:
    actuatorgroup: Bytes
    bvh_depth: int
    flags: Bytes
    flex_layer: int
    flexgroup: Bytes
    frame: int
    geomgroup: Bytes
    jointgroup: Bytes
    label: int
    sitegroup: Bytes
    skingroup: Bytes
    tendongroup: Bytes

class MjvPerturb:
    active: int
    active2: int
    flexselect: int
    localmass: float
    localpos: Floats
    refpos: Floats
    refquat: Floats
    refselpos: Floats
    scale: float
    select: int
    skinselect: int

class MjvScene:
    def __init__(self, model: MjModel, maxgeom: int) -> None: ...
    @property
    def camera(self) -> tuple[MjvGLCamera, MjvGLCamera]: ...
    @property
    def geoms(self) -> tuple[MjvGeom, ...]: ...
    @property
    def lights(self) -> tuple[MjvLight, ...]: ...
    enabletransform: int
    flags: Bytes
    framergb: Floats32
    framewidth: int
    geomorder: Ints
    maxgeom: int
    nflex: int
    ngeom: int
    nlight: int
    nskin: int
    rotate: Floats32
    scale: float
    status: int
    stereo: int
    translate: Floats32

class MjrRect:
    def __init__(self, left: int, bottom: int, width: int, height: int) -> None: ...
    left: int
    bottom: int
    width: int
    height: int

class MjrContext:
    def __init__(self, model: MjModel, fontscale: int) -> None: ...
    def free(self) -> None: ...
    charHeight: int
    charHeightBig: int
    currentBuffer: int
    fogEnd: float
    fogRGBA: NDArray[np.float32]
    fogStart: float
    glInitialized: int
    mat_texrepeat: NDArray[np.float32]
    offFBO: int
    offHeight: int
    offSamples: int
    offWidth: int
    readDepthMap: int
    shadowClip: float
    shadowSize: int
    windowAvailable: int
    windowDoublebuffer: int
    windowSamples: int

def mj_version() -> int: ...
def mj_versionString() -> str: ...
def mj_saveLastXML(filename: str, m: MjModel) -> None: ...
def mj_saveModel(m: MjModel, filename: str | None = ..., buffer: Bytes | None = ...) -> None: ...
def mj_name2id(m: MjModel, type: SupportsInt, name: str) -> int: ...
def mj_id2name(m: MjModel, type: SupportsInt, id: SupportsInt) -> str: ...
def mj_copyData(dest: MjData, m: MjModel, src: MjData) -> None: ...
def mj_resetData(m: MjModel, d: MjData) -> None: ...
def mj_resetDataKeyframe(m: MjModel, d: MjData, key: SupportsInt) -> None: ...
def mj_kinematics(m: MjModel, d: MjData) -> None: ...
def mj_comPos(m: MjModel, d: MjData) -> None: ...
def mj_comVel(m: MjModel, d: MjData) -> None: ...
def mj_camlight(m: MjModel, d: MjData) -> None: ...
def mj_tendon(m: MjModel, d: MjData) -> None: ...
def mj_transmission(m: MjModel, d: MjData) -> None: ...
def mj_crb(m: MjModel, d: MjData) -> None: ...
def mj_makeM(m: MjModel, d: MjData) -> None: ...
def mj_factorM(m: MjModel, d: MjData) -> None: ...
def mj_fullM(m: MjModel, d: MjData, dst: Floats) -> None: ...
def mj_mulM(m: MjModel, d: MjData, res: Floats, vec: ArrayLike) -> None: ...
def set_mju_user_warning(handler: Callable[[str], None] | None) -> None: ...
def mj_solveM(m: MjModel, d: MjData, x: Floats, y: ArrayLike) -> None: ...
def mj_fwdPosition(m: MjModel, d: MjData) -> None: ...
def mj_fwdVelocity(m: MjModel, d: MjData) -> None: ...
def mj_fwdActuation(m: MjModel, d: MjData) -> None: ...
def mj_fwdAcceleration(m: MjModel, d: MjData) -> None: ...
def mj_forward(m: MjModel, d: MjData) -> None: ...
def mj_step(m: MjModel, d: MjData, nstep: SupportsInt = ...) -> None: ...
def mj_step1(m: MjModel, d: MjData) -> None: ...
def mj_step2(m: MjModel, d: MjData) -> None: ...
def mj_inverse(m: MjModel, d: MjData) -> None: ...
def mj_rne(m: MjModel, d: MjData, flg_acc: SupportsInt, result: Floats) -> None: ...
def mj_rnePostConstraint(m: MjModel, d: MjData) -> None: ...
def mj_passive(m: MjModel, d: MjData) -> None: ...
def mj_collision(m: MjModel, d: MjData) -> None: ...
def mj_energyPos(m: MjModel, d: MjData) -> None: ...
def mj_energyVel(m: MjModel, d: MjData) -> None: ...
def mj_subtreeVel(m: MjModel, d: MjData) -> None: ...
def mj_setConst(m: MjModel, d: MjData) -> None: ...
def mj_jac(
    m: MjModel, d: MjData, jacp: Floats | None, jacr: Floats | None, point: ArrayLike, body: SupportsInt
) -> None: ...
def mj_jacBody(m: MjModel, d: MjData, jacp: Floats | None, jacr: Floats | None, body: SupportsInt) -> None: ...
def mj_jacBodyCom(m: MjModel, d: MjData, jacp: Floats | None, jacr: Floats | None, body: SupportsInt) -> None: ...
def mj_jacGeom(m: MjModel, d: MjData, jacp: Floats | None, jacr: Floats | None, geom: SupportsInt) -> None: ...
def mj_jacSite(m: MjModel, d: MjData, jacp: Floats | None, jacr: Floats | None, site: SupportsInt) -> None: ...
def mj_jacDot(
    m: MjModel, d: MjData, jacp: Floats | None, jacr: Floats | None, point: ArrayLike, body: SupportsInt
) -> None: ...
def mj_jacSubtreeCom(m: MjModel, d: MjData, jacp: Floats | None, body: SupportsInt) -> None: ...
def mj_objectVelocity(
    m: MjModel, d: MjData, objtype: SupportsInt, objid: SupportsInt, res: Floats, flg_local: SupportsInt
) -> None: ...
def mj_objectAcceleration(
    m: MjModel, d: MjData, objtype: SupportsInt, objid: SupportsInt, res: Floats, flg_local: SupportsInt
) -> None: ...
def mj_contactForce(m: MjModel, d: MjData, id: SupportsInt, result: Floats) -> None: ...
def mj_applyFT(
    m: MjModel, d: MjData, force: ArrayLike, torque: ArrayLike, point: ArrayLike, body: SupportsInt, qfrc_target: Floats
) -> None: ...
def mj_differentiatePos(m: MjModel, qvel: Floats, dt: float, qpos1: ArrayLike, qpos2: ArrayLike) -> None: ...
def mj_integratePos(m: MjModel, qpos: Floats, qvel: ArrayLike, dt: float) -> None: ...
def mj_normalizeQuat(m: MjModel, qpos: Floats) -> None: ...
def mj_geomDistance(
    m: MjModel, d: MjData, geom1: SupportsInt, geom2: SupportsInt, distmax: float, fromto: Floats | None
) -> float: ...
def mj_rayMesh(
    m: MjModel, d: MjData, geomid: SupportsInt, pnt: ArrayLike, vec: ArrayLike, normal: Floats | None = None
) -> float: ...
def mju_rayGeom(
    pos: ArrayLike,
    mat: ArrayLike,
    size: ArrayLike,
    pnt: ArrayLike,
    vec: ArrayLike,
    geomtype: SupportsInt,
    normal: Floats | None = None,
) -> float: ...
def mj_ray(
    m: MjModel,
    d: MjData,
    pnt: ArrayLike,
    vec: ArrayLike,
    geomgroup: ArrayLike | None,
    flg_static: bool,
    bodyexclude: SupportsInt,
    geomid: Ints | None,
    normal: Floats | None = ...,
) -> float: ...
def mj_multiRay(
    m: MjModel,
    d: MjData,
    pnt: ArrayLike,
    vec: ArrayLike,
    geomgroup: ArrayLike | None,
    flg_static: bool,
    bodyexclude: SupportsInt,
    geomid: Ints,
    dist: Floats,
    normal: Floats | None,
    nray: SupportsInt,
    cutoff: float,
) -> None: ...
def mj_getTotalmass(m: MjModel) -> float: ...
def mj_setTotalmass(m: MjModel, newmass: float) -> None: ...
def mj_stateSize(m: MjModel, sig: SupportsInt) -> int: ...
def mj_getState(m: MjModel, d: MjData, state: Floats, sig: SupportsInt) -> None: ...
def mj_setState(m: MjModel, d: MjData, state: ArrayLike, sig: SupportsInt) -> None: ...
def mju_boxQP(
    res: Floats,
    R: Floats,
    index: NDArray[np.int32] | None,
    H: ArrayLike,
    g: ArrayLike,
    lower: ArrayLike | None,
    upper: ArrayLike | None,
) -> int: ...
def mju_cholFactor(mat: Floats, mindiag: float) -> int: ...
def mju_cholSolve(res: Floats, mat: ArrayLike, vec: ArrayLike) -> None: ...
def mju_mat2Quat(quat: Floats, mat: ArrayLike) -> None: ...
def mju_quat2Mat(res: Floats, quat: ArrayLike) -> None: ...
def mju_mulQuat(res: Floats, quat1: ArrayLike, quat2: ArrayLike) -> None: ...
def mju_mulPose(
    posres: Floats, quatres: Floats, pos1: ArrayLike, quat1: ArrayLike, pos2: ArrayLike, quat2: ArrayLike
) -> None: ...
def mju_negPose(posres: Floats, quatres: Floats, pos: ArrayLike, quat: ArrayLike) -> None: ...
def mju_rotVecQuat(res: Floats, vec: ArrayLike, quat: ArrayLike) -> None: ...
def mju_axisAngle2Quat(res: Floats, axis: ArrayLike, angle: float) -> None: ...
def mju_quatIntegrate(quat: Floats, vel: ArrayLike, scale: float) -> None: ...
def mjv_defaultCamera(cam: MjvCamera) -> None: ...
def mjv_defaultFreeCamera(m: MjModel, cam: MjvCamera) -> None: ...
def mjv_defaultOption(opt: MjvOption) -> None: ...
def mjv_defaultPerturb(pert: MjvPerturb) -> None: ...
def mjv_initGeom(
    geom: MjvGeom, type: SupportsInt, size: ArrayLike, pos: ArrayLike, mat: ArrayLike, rgba: ArrayLike
) -> None: ...
def mjv_connector(geom: MjvGeom, type: SupportsInt, width: float, from_: ArrayLike, to: ArrayLike) -> None: ...
def mjv_select(
    m: MjModel,
    d: MjData,
    vopt: MjvOption,
    aspectratio: float,
    relx: float,
    rely: float,
    scn: MjvScene,
    selpnt: Floats,
    geomid: Ints,
    flexid: Ints,
    skinid: Ints,
) -> int: ...
def mjv_updateScene(
    m: MjModel, d: MjData, opt: MjvOption, pert: MjvPerturb | None, cam: MjvCamera, catmask: SupportsInt, scn: MjvScene
) -> None: ...
def mjv_makeLights(m: MjModel, d: MjData, scn: MjvScene) -> None: ...
def mjv_moveCamera(m: MjModel, action: SupportsInt, reldx: float, reldy: float, cam: MjvCamera) -> None: ...
def mjv_initPerturb(m: MjModel, d: MjData, scn: MjvScene, pert: MjvPerturb) -> None: ...
def mjv_movePerturb(
    m: MjModel, d: MjData, action: SupportsInt, reldx: float, reldy: float, scn: MjvScene, pert: MjvPerturb
) -> None: ...
def mjv_applyPerturbPose(m: MjModel, d: MjData, pert: MjvPerturb, flg_paused: SupportsInt) -> None: ...
def mjv_applyPerturbForce(m: MjModel, d: MjData, pert: MjvPerturb) -> None: ...
def mjr_render(viewport: MjrRect, scn: MjvScene, con: MjrContext) -> None: ...
def mjr_readPixels(rgb: Bytes | None, depth: Floats32 | None, viewport: MjrRect, con: MjrContext) -> None: ...
def mjr_drawPixels(rgb: ArrayLike | None, depth: ArrayLike | None, viewport: MjrRect, con: MjrContext) -> None: ...
def mjr_setBuffer(framebuffer: SupportsInt, con: MjrContext) -> None: ...
def mjr_uploadTexture(m: MjModel, con: MjrContext, texid: SupportsInt) -> None: ...
def mjr_uploadMesh(m: MjModel, con: MjrContext, meshid: SupportsInt) -> None: ...
def mjr_overlay(
    font: SupportsInt, gridpos: SupportsInt, viewport: MjrRect, overlay: str, overlay2: str, con: MjrContext
) -> None: ...
def mjr_text(
    font: SupportsInt, txt: str, con: MjrContext, x: float, y: float, r: float, g: float, b: float
) -> None: ...
def mjr_label(
    viewport: MjrRect,
    font: SupportsInt,
    txt: str,
    r: float,
    g: float,
    b: float,
    a: float,
    rt: float,
    gt: float,
    bt: float,
    con: MjrContext,
) -> None: ...
def mjr_rectangle(viewport: MjrRect, r: float, g: float, b: float, a: float) -> None: ...
def mjr_maxViewport(con: MjrContext) -> MjrRect: ...
def mjr_resizeOffscreen(width: SupportsInt, height: SupportsInt, con: MjrContext) -> None: ...
def mjr_blitBuffer(
    src: MjrRect, dst: MjrRect, flg_color: SupportsInt, flg_depth: SupportsInt, con: MjrContext
) -> None: ...
def mjr_finish() -> None: ...
def mjr_changeFont(fontscale: SupportsInt, con: MjrContext) -> None: ...
