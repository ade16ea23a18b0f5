classdef {{name}} < handle
    % {{name}}  Watches an actuator in service for: {{cause}}.
    %
{{about}}
    %
    % Fixed time step {{time_step}} s. Angles in deg, voltages in V. {{name}}_base.m and
    % {{name}}_extended.m lie beside it.
    %
    %   monitor = {{name}}(65.0);                     % the actuator rests at a voltage
    %   seen = monitor.step(volt, measured_deg);
    %   if seen == {{name}}.CAUSE, end                % or SOUND, OTHER
    %   rows = monitor.watch_all(volts, measured);    % whole histories

    properties (Constant)
        THRESHOLD_DEG = {{threshold}};    % RMS residual that a sound actuator does not reach, deg
        SOUND = 0;    % the residual is within the threshold
        CAUSE = 1;    % it is beyond, and within once the amount of the cause, above 0, is taken off
        OTHER = 2;    % it is beyond, with the cause taken off too, or the amount is 0 or below
    end

    properties (SetAccess = private)
        residual_deg = 0;    % RMS of what was measured less the base, deg
        amount = 0;          % amount of the cause: 0 none, 1 as it was diagnosed
        left_deg = 0;        % RMS residual with that amount taken off, deg
        seen = 0;            % SOUND, CAUSE or OTHER
    end

    properties (Access = private)
        base                 % the actuator as it was
        extended             % the actuator with the cause
        sums                 % means of 1, r r, r e, e e, with weights
    end

    methods
        function obj = {{name}}(volt)
            % Begins with the actuator at rest at a voltage, V.
            obj.base = {{name}}_base(volt);
            obj.extended = {{name}}_extended(volt);
            obj.sums = zeros(1, 4);
        end

        function seen = step(obj, volt, measured_deg)
            % One time step on: the voltage at its end, V, and the flap angle measured there, deg.
            % What is seen. A measurement that is not a finite number is left out.
            kept = {{kept}};
            base_deg = obj.base.step(volt);
            r = measured_deg - base_deg;
            e = obj.extended.step(volt) - base_deg;
            if isfinite(r) && isfinite(e)
                obj.sums = kept * obj.sums + (1.0 - kept) * [1.0, r * r, r * e, e * e];
                obj.judge();
            end
            seen = obj.seen;
        end

        function rows = watch_all(obj, volts, measured)
            % What is seen at every sample of a voltage history, V, and measured flap angles, deg, from
            % here on: columns residual_deg, amount, left_deg, seen.
            if numel(volts) ~= numel(measured)
                error('%d voltages and %d angles; give one angle for each voltage', ...
                      numel(volts), numel(measured));
            end
            rows = zeros(numel(volts), 4);
            for i = 1:numel(volts)
                obj.step(volts(i), measured(i));
                rows(i, :) = [obj.residual_deg, obj.amount, obj.left_deg, obj.seen];
            end
        end
    end

    methods (Access = private)
        function judge(obj)
            weight = obj.sums(1);
            rr = obj.sums(2);
            re = obj.sums(3);
            ee = obj.sums(4);
            if ee > 0.0
                obj.amount = re / ee;
            else
                obj.amount = 0.0;
            end
            obj.residual_deg = sqrt(rr / weight);
            obj.left_deg = sqrt(max(rr - obj.amount * re, 0.0) / weight);
            if obj.residual_deg <= obj.THRESHOLD_DEG
                obj.seen = obj.SOUND;
            elseif obj.left_deg <= obj.THRESHOLD_DEG && obj.amount > 0.0
                obj.seen = obj.CAUSE;
            else
                obj.seen = obj.OTHER;
            end
        end
    end
end
